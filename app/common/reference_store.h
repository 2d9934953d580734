#pragma once
// References as files: the irradiance that a reference method gave a picture, named by a hash of
// everything it depends on, so that one program makes it and others read it without tracing a ray.
//
// <method>-<hash>.npy           float32, height x width x 3, top row first: irradiance, W/m^2
// <method>-<hash>.variance.npy  the same of its variance (pathtraced)
// <method>-<hash>.partial.npy   rows done so far, bottom first, while it is not complete
// <method>-<hash>.txt           what was hashed

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/frame_renderer.h"

namespace mv {

// Parts of a reference's description, one "name value" a line: what the scene is at this moment and
// how it is lit, and which views there are.
std::string describeScene(const Scene& scene);
std::string describeMoment(const Settings& settings, const FrameInput& input);
std::string describeViews(const Settings& settings, std::span<const View> views);
// <folder>/<kind>-<hash of the description>, without extension; empty without a folder.
std::filesystem::path referenceFile(const std::filesystem::path& folder, std::string_view kind,
                                    std::string_view description);
// One of the files of that name.
std::filesystem::path withExtension(std::filesystem::path file, const char* extension);
// Makes the folder that the file lies in. Throws Error(ExitCode::output).
void makeFolderOf(const std::filesystem::path& file);

// What the light of a reference method is made from.
struct ReferenceRequest {
    Settings settings;  // of the side, whose method it is
    FrameInput input;
    std::vector<View> views;          // by slot
    std::vector<Receiver> receivers;  // width * height, bottom row first
};

// Rows bottom first, as the receivers of a ReferenceRequest.
struct StoredReference {
    int width = 0, height = 0, rowsDone = 0;
    std::vector<glm::vec3> mean, variance;  // variance may be empty
};

class ReferenceStore {
  public:
    // An empty folder keeps nothing.
    explicit ReferenceStore(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // What a reference depends on, one setting a line: scene, camera, resolution, time, lights,
    // and for the method exact also the views and the clamp.
    static std::string description(const Scene& scene, const ReferenceRequest& request);

    // Without extension; empty if nothing is kept.
    std::filesystem::path fileFor(const Scene& scene, const ReferenceRequest& request) const;
    // Complete or partial, of this size; nothing if there is none or it cannot be read.
    std::optional<StoredReference> load(const std::filesystem::path& file, int width,
                                        int height) const;
    // Throws Error(ExitCode::output).
    void save(const std::filesystem::path& file, const StoredReference& reference,
              const std::string& description) const;

  private:
    std::filesystem::path folder_;
};

}  // namespace mv
