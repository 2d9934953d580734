#pragma once
// What MegaViews and ManyLoDs share of their host side: all but the view hierarchy.

#include "renderer/methods/megaviews/many_view_pass.h"
#include "renderer/visibility.h"

namespace mv {

class ManyViewVisibility : public Visibility {
  public:
    explicit ManyViewVisibility(gl::Results results) : pass_(results) {}
    Proof proof(MethodStatistics& statistics) override;
    bool mapsLag() const override { return pass_.mapsLag(); }

  private:
    MethodSettings read(const MethodSettings& settings) const override;
    void make(const VisibilityInput& input, const MethodSettings& settings, gl::Profiler& profiler,
              MethodStatistics& statistics) override;
    ManyViewPass pass_;
};

}  // namespace mv
