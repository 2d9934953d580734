#pragma once
// Makes the pictures of the methods exact and pathtraced, and exact maps, by rays on the CPU, and
// keeps them (ReferenceStore). Work that is interrupted goes on where it stopped.

#include <filesystem>
#include <functional>
#include <memory>

#include "app/common/run_options.h"
#include "app/common/scene_assets.h"
#include "megaviews/core/progress.h"
#include "megaviews/measure/reference_store.h"

namespace mv {

class References {
  public:
    // `folder` empty: nothing is kept. `progress` may throw Cancelled. assets outlive this.
    References(const SceneAssets& assets, std::filesystem::path folder, Progress progress);
    ~References();

    // Called with what irradiance() has made so far, from its thread, at every row.
    using Watch = std::function<void(const std::vector<glm::vec3>&)>;
    void setWatch(Watch watch);

    // Irradiance as FrameRenderer::setReference takes it, from the store or made now and stored,
    // with an EXR beside it; what cannot be stored is a warning. Throws Error(ExitCode::usage) for
    // what the method cannot do.
    std::vector<glm::vec3> irradiance(const ReferenceRequest& request);

    // Exact maps of `count` of the views, or of all that live, at settings.side[0].maps.resolution:
    // from the store or made now and stored.
    MapReferences maps(const ReferenceRequest& request, std::size_t count);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Where the options keep references; empty: nowhere.
std::filesystem::path referenceFolder(const RunOptions& options);

}  // namespace mv
