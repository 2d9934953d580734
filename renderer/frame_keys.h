#pragma once
// What each stage of a frame depends on: while its key stays the same, a stage is not run again.
// Used by FrameRenderer only.

#include <cstring>
#include <vector>

#include "megaviews/settings/settings.h"
#include "megaviews/views/frame_camera.h"
#include "shaders/shared/types.glsl"

namespace mv {

struct LightsKey {
    std::vector<LightRecord> lights;
    bool operator==(const LightsKey& o) const {
        return lights.size() == o.lights.size() &&
               (lights.empty() || std::memcmp(lights.data(), o.lights.data(),
                                              lights.size() * sizeof(LightRecord)) == 0);
    }
};

struct ViewsKey {
    LightsKey lights;
    std::int64_t vpls = 0, particles = 0;
    int bounces = 0;
    Placement placement = Placement::traced;
    std::uint32_t seed = 0;
    double timeS = 0;  // particles move with it
    double lightScale = 1;
    std::uint64_t generation = 0;  // of scene and loaded views
    int viewDepth = 0;
    bool operator==(const ViewsKey&) const = default;
};

struct GBufferKey {
    FrameCamera camera;
    int width = 0, height = 0;
    std::uint64_t generation = 0, particlesVersion = 0;
    bool operator==(const GBufferKey& o) const {
        return camera.position == o.camera.position && camera.forward == o.camera.forward &&
               camera.up == o.camera.up && camera.yfovRad == o.camera.yfovRad &&
               camera.orthoHalfHeight == o.camera.orthoHalfHeight && width == o.width &&
               height == o.height && generation == o.generation &&
               particlesVersion == o.particlesVersion;
    }
};

struct DirectKey {
    LightsKey lights;
    std::uint64_t gbufferVersion = 0;
    bool operator==(const DirectKey&) const = default;
};

struct MapsKey {
    Method method = Method::none;
    Traversal traversal = Traversal::lists;
    Rules rules = Rules::corrected;
    int viewRes = 0;
    bool fusion = true, holeFill = true;
    double pairSize = 1;
    int gpuMemoryMiB = 0, queueMemoryMiB = 0;
    int ismPoints = 0, ismPool = 0;
    std::uint32_t seed = 0;  // of what is drawn at random for the maps
    bool countLevels = false;
    std::uint64_t viewsVersion = 0;
    bool operator==(const MapsKey&) const = default;
};

// Which views each receiver keeps: shared by both sides of a comparison.
struct CullKey {
    std::uint64_t viewsVersion = 0, gbufferVersion = 0;
    int scale = 1, cullLevel = 0;
    double cutoff = 0;
    bool operator==(const CullKey&) const = default;
};

// What one side's samples depend on; while it stays the same, sets of them accumulate.
struct GatherKey {
    std::uint64_t cullVersion = 0, mapsVersion = 0;
    Rules rules = Rules::corrected;
    int samples = 0;
    double clampDistance = 0, bias = 1;
    bool filter = true;
    std::uint32_t seed = 0;
    int referenceSamples = 0;  // of methods that are references
    bool operator==(const GatherKey&) const = default;
};

// Of the pictures of sharing, which no light changes.
struct SharingKey {
    DebugView view = DebugView::sharing;
    std::uint64_t mapsVersion = 0, gbufferVersion = 0;
    std::uint32_t seed = 0;
    std::optional<std::int64_t> pickA, pickB;
    bool operator==(const SharingKey&) const = default;
};

}  // namespace mv
