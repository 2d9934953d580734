#pragma once
// Ground truth without VPLs: the indirect light of a receiver by path tracing from it, with
// next-event estimation. It includes exactly the paths that the VPL tracer
// (shaders/shared/vpl.glsl) makes, and neither the clamp nor a view set, so that an exact gather of
// N views differs from it by what VPLs themselves cost (docs/references.md).

#include <cstdint>
#include <span>

#include "megaviews/gather/receiver.h"
#include "megaviews/references/embree_scene.h"
#include "megaviews/references/rows.h"
#include "megaviews/views/view_set.h"

namespace mv {

struct PathTraceOptions {
    int bounces = 4;  // reflections between a light and the receiver, 1 .. bounces; as VplOptions
    std::uint32_t samples = 256;  // paths a pixel
    std::uint32_t seed = 0;
    bool gloss = false;  // surfaces reflect with theirs, as matt ones: TriangleBvh::data()
};

// E(x) = emissive surfaces and sky seen directly + light of punctual lights, emissive surfaces and
// sky after 1 .. bounces diffuse reflections. Punctual lights seen directly are left out: the
// direct light pass has them. `image` gets mean and variance of the mean; random numbers hash
// (seed, pixel, sample), sums run in the order of the samples. Resumes as exactGather does.
void pathTrace(const EmbreeScene& embree, const Emitters& emitters,
               std::span<const Receiver> receivers, int width, int height,
               const PathTraceOptions& options, IrradianceImage& image,
               const Progress& progress = {});

}  // namespace mv
