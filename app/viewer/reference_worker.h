#pragma once
// Makes the references that a window shows on a thread of its own: one picture after the other,
// each abandoned as soon as nobody wants it, its rows kept (References).

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "app/common/scene_assets.h"
#include "megaviews/settings/error.h"
#include "renderer/frame_renderer.h"

namespace mv {

class ReferenceWorker : public ReferenceMaker {
  public:
    explicit ReferenceWorker(std::filesystem::path folder);  // empty: nothing is kept
    ~ReferenceWorker() override;                             // abandons all and waits for a row
    ReferenceWorker(const ReferenceWorker&) = delete;
    ReferenceWorker& operator=(const ReferenceWorker&) = delete;

    // Abandons what it makes. The scene is kept as long as it is needed.
    void setScene(std::shared_ptr<const SceneAssets> assets);

    void begin(const ReferenceRequest& request, int side) override;
    void end(int side) override;
    Light more(int side) override;

    bool busy() const { return busy(0) || busy(1); }
    bool busy(int side) const;  // begun, and neither complete nor failed
    bool news() const;          // more() has something to say
    struct Status {
        std::string stage;  // empty: idle
        float fraction = 0;
    };
    Status status() const;  // of the picture that is being made
    struct Failure {
        int side = 0;
        Error error;
    };
    std::optional<Failure> takeFailure();  // each once

  private:
    struct Job;
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv
