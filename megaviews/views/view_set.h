#pragma once
// The views of a frame: virtual point lights or glowing particles (Scene + lights -> ViewSet).
// Flux in W, positions in root-cube units, lights' intensities in W/sr (point, spot) and W/m^2
// (directional), emission in W/(m^2 sr) with m the file's unit of length.

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "megaviews/scene/scene.h"
#include "megaviews/scene/triangle_bvh.h"
#include "megaviews/settings/light_placement.h"
#include "megaviews/views/sky.h"
#include "shaders/shared/random.glsl"
#include "shaders/shared/types.glsl"
#include "shaders/shared/vpl.glsl"

namespace mv {

struct ViewSet {
    std::vector<View> views;    // by slot; dead slots included
    std::string fileHash = {};  // of the file they are from, if they are
    std::uint64_t alive() const;
};

// Seed of the views that light a still picture's n-th set of samples, n >= 1, where each set has
// views of its own; the first has those of the picture's seed.
inline std::uint32_t viewSeed(std::uint32_t seed, int n) {
    return n == 1 ? seed : pcg4d({seed, static_cast<std::uint32_t>(n), 0, 0}).x;
}

// Every triangle that shines, with its share of their power. Lights that move leave it as it is:
// make it once a scene, or once a pose if what shines moves.
struct EmissiveSurfaces {
    std::vector<EmissiveTriangle> triangles;
    glm::vec3 fluxW{0};  // of all together, at light scale 1
    bool moves = false;  // some of it
};
std::shared_ptr<const EmissiveSurfaces> makeEmissiveSurfaces(const Scene& scene,
                                                             const TriangleBvh& bvh);

// To the bit.
inline bool operator==(const LightRecord& a, const LightRecord& b) {
    using Words = std::array<std::uint32_t, sizeof(LightRecord) / 4>;
    return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

// What shooting VPLs needs beside the triangles, made on the CPU each time a light moves.
struct Emitters {
    std::vector<LightRecord> lights;  // punctual, root-cube units; then that of the sky, if any
    std::shared_ptr<const Sky> sky;   // null: none
    std::shared_ptr<const EmissiveSurfaces> surfaces;  // null: none
    float lightScale = 1;                              // of the surfaces; in the lights already
    glm::vec3 center{0.5f};  // of the scene's bounding sphere, root-cube units
    float radius = 0.5f;
    std::uint32_t emissiveCount() const {
        return surfaces ? static_cast<std::uint32_t>(surfaces->triangles.size()) : 0u;
    }
    float skyAreaM2 = 0;  // of the disc that each of the sky's directions shines through
    const SkyTexel* skyTexels() const { return sky ? sky->texels.data() : nullptr; }
    glm::vec3 fluxW() const;  // sent into the scene by all of them
    bool empty() const;       // nothing has any flux
};

// How the scene is lit: when, and what the user has made of its lights.
struct Lighting {
    double timeS = 0;
    int animation = -1;  // index into Scene::animations, -1: none
    double scale = 1;    // of all of them, the sky included
    std::vector<LightPlacement> placements = {};
    Environment environment = {};
};
// Fluxes: point 4 pi I, spot its falloff over solid angle, directional irradiance times the area
// of the disc across the scene's bounding sphere, the sky the same of each direction. A light
// without flux is listed, never chosen; so is one that was placed where the environment stands
// instead of it. `before`: a sky that may still be the right one. Throws Error(ExitCode::usage) for
// a placement of a light that the scene does not have.
Emitters makeEmitters(const Scene& scene, const TriangleBvh& bvh,
                      std::shared_ptr<const EmissiveSurfaces> surfaces, const Lighting& lighting,
                      std::shared_ptr<const Sky> before = nullptr);
// The same, making the surfaces anew: for when there is only one frame.
Emitters makeEmitters(const Scene& scene, const TriangleBvh& bvh, const Lighting& lighting);

// The scene's lights at a time, as the user has them. Throws Error(ExitCode::usage) for a light
// that the scene does not have; what a light has not (where the sun stands) changes nothing.
std::vector<PosedLight> placedLights(const Scene& scene, double timeS, int animation,
                                     const std::vector<LightPlacement>& placements);

struct VplOptions {
    std::uint64_t count = 4096;  // slots, at most 2^31
    int bounces = 4;             // VPLs a path
    std::uint32_t seed = 0;
    bool gloss = false;  // surfaces reflect with theirs: TriangleBvh::data()
};

struct ViewGuide;  // view_guide.h

// Slots and paths of a frame. ceil(count / bounces) paths, cut to count; with emissive surfaces
// the first quarter of the slots (rounded up) are bounce-0 VPLs and the paths share the rest.
// guide: where paths begin; null: wherever light does.
VplSetup makeVplSetup(const Emitters& emitters, const VplOptions& options,
                      const ViewGuide* guide = nullptr);

// [Kol19 §4.1]: a VPL at each bounce with the propagated flux, no roulette, hashed by
// (seed, path, bounce). A path that leaves the scene or meets a black surface leaves dead slots:
// all zero. The CPU twin of renderer/passes/vpl_pass.h, by the same lines (shaders/shared/vpl.glsl,
// which says where slots lie).
ViewSet traceVpls(const TriangleBvh& bvh, const Emitters& emitters, const VplOptions& options,
                  const ViewGuide* guide = nullptr);

// The box of all corners of triangles, wherever they move, root-cube units; the middle of the cube
// for an empty scene.
struct SceneBounds {
    glm::vec3 min{0.25f}, max{0.75f};
};
SceneBounds sceneBounds(const Scene& scene);

// Omnidirectional lights on smooth closed paths inside the box, with saturated colours, all of the
// same power. powerW is the flux of all of them together, as the mean of the three channels. Slot
// k's path and colour depend on (seed, k) alone, its place continuously on the time.
ViewSet makeParticles(const SceneBounds& bounds, std::uint64_t count, std::uint32_t seed,
                      double timeS, double powerW);
ViewSet makeParticles(const Scene& scene, std::uint64_t count, std::uint32_t seed, double timeS,
                      double powerW);

// Views at random places in the box, looking in random directions, of the same white flux, powerW
// for all of them together: the least coherent there are [Kol19 fig. 11]. Slot k depends on
// (seed, k) alone.
ViewSet makeRandomViews(const SceneBounds& bounds, std::uint64_t count, std::uint32_t seed,
                        double powerW);

}  // namespace mv
