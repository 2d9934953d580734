#pragma once
// Ground truth for the gather: the light of every view at every receiver with visibility by shadow
// rays. What a many-view method and its subsampled, filtered gather should converge to; the clamp
// and the view set are the same (docs/references.md).

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "megaviews/gather/receiver.h"
#include "megaviews/references/embree_scene.h"
#include "megaviews/references/rows.h"
#include "megaviews/views/sky.h"
#include "shaders/shared/types.glsl"

namespace mv {

struct ExactGatherOptions {
    // Root-cube units; nullopt: of each view by its neighbours (megaviews/views/view_spacing.h).
    std::optional<float> clampDistance = 0.01f;
    bool visibility = true;  // false: every view sees every receiver, as method none
    // Gives back what the clamp takes, by so many short rays a receiver (near_field.glsl); 0: not.
    int nearFieldRays = 0;
    // Of those: punctual lights, surfaces that glow, where the views stand for their light, and the
    // bounces of the views' paths.
    std::vector<LightRecord> lights = {};
    float emissionScale = 0;
    int bounces = 4;
    bool gloss = false;  // they reflect with theirs, as matt ones: TriangleBvh::data()
    // Its light, by so many rays a receiver (sky.glsl), and on near surfaces; null: none.
    std::shared_ptr<const Sky> sky = nullptr;
    int skyRays = 256;
    std::uint32_t seed = 0;  // of the rays' directions
};

// For width * height receivers in rows, at their true positions; a zero normal is no surface. Each
// pixel is sum over views of flux * gatherTerm / edge^2, in the order of the views, in double, and
// the mean of the rays towards the sky.
// Shadow rays run from the receiver, lifted as VPLs are, to the view's own position; alpha masks
// are honoured. Dead views are left out. `image` goes on from its rowsDone: give {} to begin, or
// what a cancelled call left there, with all else the same.
void exactGather(const EmbreeScene& embree, std::span<const View> views,
                 std::span<const Receiver> receivers, int width, int height,
                 const ExactGatherOptions& options, IrradianceImage& image,
                 const Progress& progress = {});

}  // namespace mv
