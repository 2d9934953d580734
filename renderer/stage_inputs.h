#pragma once
// What each stage of a frame last ran with: its own settings struct and the versions of its input.
// It runs again where they differ, so that no list says which settings matter to what.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "megaviews/settings/settings.h"
#include "megaviews/views/frame_camera.h"
#include "megaviews/views/importance.h"
#include "renderer/passes/gpu_data.h"

namespace mv {

// What views are traced from, or placed by.
struct ViewsInput {
    ViewSettings settings;
    std::vector<LightRecord> lights;
    std::shared_ptr<const Sky> sky;
    double lightScale = 1;
    bool gloss = false;  // light bounces off surfaces with their gloss
    std::uint32_t seed = 0;
    double timeS = 0;                        // of particles, which move with it
    std::uint64_t generation = 0;            // of scene and loaded views
    std::uint64_t poseNumber = 0;            // Scene::poseNumber
    std::optional<ImportanceCamera> camera;  // where views follow what it sees
    bool operator==(const ViewsInput&) const = default;
};

struct GBufferInputs {
    FrameCamera camera;
    Size resolution;
    std::uint64_t generation = 0, pose = 0;
    std::uint64_t particles = 0;  // version of the views that are drawn as particles; 0: none are
    std::shared_ptr<const Sky> sky;
    Materials materials{};
    bool operator==(const GBufferInputs&) const = default;
};

struct DirectInputs {
    std::vector<LightRecord> lights;
    std::uint64_t gbuffer = 0;
    bool operator==(const DirectInputs&) const = default;
};

struct SkyMapsInputs {
    std::shared_ptr<const Sky> sky;
    std::uint64_t generation = 0, pose = 0;
    int views = 0, resolution = 0;
    std::uint64_t budget = 0;  // bytes
    bool operator==(const SkyMapsInputs&) const = default;
};

struct CullInputs {
    CullSettings cull;
    std::optional<double> clampDistance;
    std::uint64_t views = 0, gbuffer = 0;
    bool operator==(const CullInputs&) const = default;
};

// What a side's samples depend on. While it stays the same, sets of samples accumulate.
struct SampleInputs {
    GatherSettings gather;
    uint rules = 0;
    std::uint32_t seed = 0;
    int referenceSamples = 0;  // 0 unless the side is a reference
    std::uint64_t cull = 0, maps = 0;
    bool ownSamples = false, averagesViews = false;
    std::optional<DebugView> pointsView;  // where points of pixels are averaged
    bool operator==(const SampleInputs&) const = default;
};

// What the light in a side's history depends on. Where it changes, the history begins anew.
struct HistoryInputs {
    MethodSettings method;
    ViewSettings views;
    GatherSettings gather;
    double lightScale = 1;
    EnvironmentSettings environment;
    std::uint32_t seed = 0;
    std::uint64_t generation = 0;
    bool operator==(const HistoryInputs&) const = default;
};

// What the surfaces met by reflection rays, their direct light and their culled view lists depend
// on.
struct ReflectionInputs {
    std::uint64_t drawing = 0;  // GBuffer::drawing of the surfaces that the rays leave
    int set = 0;
    std::uint32_t setsBefore = 0, seed = 0;
    std::uint64_t cull = 0, views = 0;
    std::vector<LightRecord> lights;
    float lightScale = 1;
    bool operator==(const ReflectionInputs&) const = default;
};

// What a picture of shared pairs depends on.
struct SharingInputs {
    DebugView view{};
    InspectSettings picked;
    std::uint32_t seed = 0;
    std::uint64_t maps = 0, gbuffer = 0;
    bool operator==(const SharingInputs&) const = default;
};

}  // namespace mv
