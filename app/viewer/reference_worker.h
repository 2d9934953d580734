#pragma once
// Makes the references that a window shows on a thread of its own: pictures and exact maps, one
// after the other, each abandoned as soon as nobody wants it; rows of a picture are kept
// (References).

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/common/scene_assets.h"
#include "megaviews/core/error.h"
#include "megaviews/measure/reference_store.h"

namespace mv {

class ReferenceWorker {
  public:
    explicit ReferenceWorker(std::filesystem::path folder);  // empty: nothing is kept
    // Abandons all and waits for a row, or as much of the maps.
    ~ReferenceWorker();
    ReferenceWorker(const ReferenceWorker&) = delete;
    ReferenceWorker& operator=(const ReferenceWorker&) = delete;

    // Abandons what it makes. The scene is kept as long as it is needed.
    void setScene(std::shared_ptr<const SceneAssets> assets);

    // Abandons all, and waits as ~ReferenceWorker does: until it is asked for more the scene may
    // change.
    void rest();

    // Begins a picture for a side, 0 or 1, instead of what it made for that side.
    void begin(ReferenceRequest request, int side);
    void end(int side);
    struct Light {
        std::vector<glm::vec3> irradiance;  // so far, 0 where it is not done; empty: nothing new
        bool complete = false;
    };
    // What that side's picture has gained since the last call.
    Light more(int side);

    // Exact maps for a side, as References::maps gives them, instead of those it had or was making.
    void beginMaps(ReferenceRequest request, std::size_t count, int side);
    void endMaps(int side);
    // Null until they are there.
    std::shared_ptr<const MapReferences> maps(int side) const;

    bool busy() const { return busy(0) || busy(1) || busyWithMaps(); }
    bool busy(int side) const;  // begun, and neither complete nor failed
    bool busyWithMaps() const;
    struct Status {
        std::string stage;  // empty: idle
        float fraction = 0;
    };
    Status status() const;  // of what is being made
    struct Failure {
        int side = 0;
        bool ofMaps = false;
        Error error;
    };
    std::optional<Failure> takeFailure();  // each once

  private:
    struct Job;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
