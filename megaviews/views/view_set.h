#pragma once
// The views of a frame: virtual point lights or glowing particles (Scene + lights -> ViewSet).
// Units, slots and clamp as docs/light.md says: flux in W, distances in root-cube units.

#include <cstdint>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"
#include "shaders/shared/types.glsl"

namespace mv {

struct ViewSet {
    std::vector<View> views;         // by slot; dead slots included
    std::uint64_t alive() const;
};

// What shooting VPLs needs beside the triangles, made on the CPU each time a light moves.
struct Emitters {
    std::vector<LightRecord> lights;             // punctual, root-cube units
    std::vector<EmissiveTriangle> triangles;     // cumulative by power
    glm::vec3 emissiveFluxW{0};                  // of all emissive surfaces together
    bool empty() const { return lights.empty() && triangles.empty(); }
};
Emitters makeEmitters(const Scene& scene, const TriangleBvh& bvh, double timeS, int animation,
                      double lightScale);

struct VplOptions {
    std::uint64_t count = 4096;  // slots
    int bounces = 4;             // VPLs a path
    std::uint32_t seed = 0;
};

// [Kol19 §4.1]: a VPL at each bounce with the propagated flux, no roulette, hashed by
// (seed, path, bounce). A quarter of the slots are bounce-0 VPLs on emissive surfaces if there
// are any. The CPU twin of renderer/passes/vpl_pass.h, by the same lines.
ViewSet traceVpls(const TriangleBvh& bvh, const RootCube& root, const Emitters& emitters,
                  const VplOptions& options);

// Omnidirectional lights on smooth closed paths inside the scene's box, with colours; powerW is
// the flux of all of them together.
ViewSet makeParticles(const Scene& scene, std::uint64_t count, std::uint32_t seed, double timeS,
                      double powerW);

}  // namespace mv
