// No visibility: every view lights every surface that faces it. What is lost without shadows.

#include "renderer/visibility.h"

namespace mv {
namespace {

class NoVisibility : public Visibility {
    void make(const VisibilityInput&, const MethodSettings&, gl::Profiler&,
              MethodStatistics&) override {}
};

}  // namespace

template <>
std::unique_ptr<Visibility> makeVisibility<Method::none>(gl::Results) {
    return std::make_unique<NoVisibility>();
}

}  // namespace mv
