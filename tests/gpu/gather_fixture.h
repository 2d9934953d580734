#pragma once
// A small room, views on its walls, ray-traced maps and a ray-cast G-buffer for the gather's tests:
// everything the passes read, made without the passes before them.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "gather/random_views.h"
#include "megaviews/core/error.h"
#include "megaviews/gather/gather.h"
#include "renderer/gl/context.h"
#include "renderer/passes/gather_pass.h"
#include "renderer/passes/scene_hierarchy_upload.h"
#include "shaders/shared/gather.glsl"
#include "shaders/shared/parametrisation.glsl"
#include "support/upload_views.h"

namespace mv::test {

// Many samples by power alone, clamped alike, answered by the maps: what is worked out easily.
inline GatherOptions plainOptions() {
    GatherOptions options;
    options.samples = 64;
    options.candidates = 1;
    options.clampDistance = 0.01;
    options.mapCheck = 0;
    return options;
}
// What the reference of such a gather is asked.
inline GatherReferenceOptions referenceOf(const GatherOptions& options, const RootCube& root) {
    return {static_cast<float>(options.clampDistance.value()), static_cast<float>(root.edge),
            options.rules, static_cast<float>(options.cull.cutoff),
            static_cast<float>(options.bias)};
}

inline void addQuad(Scene& scene, vec3 corner, vec3 a, vec3 b) {
    const auto first = static_cast<uint>(scene.positions.size());
    const vec3 n = normalize(cross(a, b));
    for (const vec3 p : {corner, corner + a, corner + a + b, corner + b}) {
        scene.positions.push_back(p);
        scene.normals.push_back(n);
    }
    scene.triangles.push_back({first, first + 1, first + 2});
    scene.triangles.push_back({first, first + 2, first + 3});
    scene.triangleMaterials.insert(scene.triangleMaterials.end(), 2, 0);
}
// Faces outwards, or inwards if `inside`.
inline void addBox(Scene& scene, vec3 lo, vec3 hi, bool inside) {
    for (int axis = 0; axis < 3; ++axis) {
        vec3 a(0), b(0);
        a[(axis + 1) % 3] = hi[(axis + 1) % 3] - lo[(axis + 1) % 3];
        b[(axis + 2) % 3] = hi[(axis + 2) % 3] - lo[(axis + 2) % 3];
        vec3 far = lo;
        far[axis] = hi[axis];
        if (inside) std::swap(a, b);
        addQuad(scene, far, a, b);
        addQuad(scene, lo, b, a);
    }
}

// A room of 6 m with a block in it: 24 triangles.
inline Scene roomScene() {
    Scene scene;
    scene.name = "room";
    scene.root.edge = 8;
    scene.materials.resize(1);
    addBox(scene, vec3(0.125f), vec3(0.875f), true);
    addBox(scene, {0.4f, 0.125f, 0.35f}, {0.6f, 0.5f, 0.55f}, false);
    return scene;
}

struct Room {
    Scene scene = roomScene();
    TriangleBvh bvh = TriangleBvh::build(scene);
    SceneHierarchy hierarchy = SceneHierarchy::build(scene, bvh, 7);

    // VPLs on random surface points with fluxes over four decades, and some particles.
    std::vector<View> views(std::size_t count, unsigned seed, double particles = 0.1) const {
        Rng rng(seed);
        std::vector<View> out;
        while (out.size() < count) {
            const vec3 flux = point(rng, 0.1f, 1) * std::pow(10.0f, uniform(rng, -3, 1));
            if (uniform(rng, 0, 1) < static_cast<float>(particles)) {
                out.push_back(makeParticle(point(rng, 0.65f, 0.85f), flux));
                continue;
            }
            const vec3 from(0.3f, 0.6f, 0.7f), d = direction(rng);
            const auto hit = bvh.intersect(from, d, 0, 10);
            if (!hit) continue;
            const vec3 n = scene.normals[scene.triangles[hit->triangle].x];
            out.push_back(makeView(from + d * hit->t + n * 1e-4f, n, flux));
        }
        numberSlots(out);
        return out;
    }

    // What an exact renderer stores in each texel seen from each centre.
    std::vector<std::uint32_t> trace(vec3 center, uint res) const {
        std::vector<std::uint32_t> texels(mapTexels(res), kNone);
        for (uint t = 0; t < mapTexels(res); ++t) {
            const auto hit = bvh.intersect(center, texelDirection(t, res), 1e-5f, 10);
            if (hit && texelReachable(t, res)) texels[t] = floatBitsToUint(hit->t);
        }
        return texels;
    }
    ViewMaps traceMaps(const ViewHierarchy& h, int res) const {
        ViewMaps maps;
        maps.mapRes = res;
        maps.centers.resize(h.leafCount);
        const std::size_t size = mapTexels(static_cast<uint>(res));
        maps.texels.resize(h.leafCount * size);
        for (std::size_t n = 0; n < h.nodes.size(); ++n) {
            if (h.mapOfNode[n] == kNone) continue;
            maps.centers[h.mapOfNode[n]] = boxCenter(h.nodes[n]);
            const auto texels = trace(boxCenter(h.nodes[n]), static_cast<uint>(res));
            std::copy(texels.begin(), texels.end(),
                      maps.texels.begin() + static_cast<std::ptrdiff_t>(h.mapOfNode[n] * size));
        }
        return maps;
    }

    // Seen from inside the room; the last columns see nothing.
    GBuffer gbuffer(int width, int height) const {
        std::vector<float> positions, normals;
        const vec3 eye(0.2f, 0.7f, 0.8f);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const float u = (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - 0.5f;
                const float v = (static_cast<float>(y) + 0.5f) / static_cast<float>(height) - 0.5f;
                const vec3 d = normalize(vec3(1.4f + u, v * 1.2f - 0.5f, u * 1.5f - 1));
                const auto hit = bvh.intersect(eye, d, 0, 10);
                const bool present = hit && (x < width - width / 16);
                const vec3 p = present ? eye + d * hit->t : vec3(0);
                const vec3 n = present ? scene.normals[scene.triangles[hit->triangle].x] : vec3(0);
                positions.insert(positions.end(), {p.x, p.y, p.z, present ? 1.0f : 0.0f});
                normals.insert(normals.end(), {n.x, n.y, n.z, present ? hit->t : 0.0f});
            }
        }
        return makeGBuffer(width, height, positions, normals);
    }
    static GBuffer makeGBuffer(int width, int height, const std::vector<float>& positions,
                               const std::vector<float>& normals) {
        GBuffer g;
        g.width = width;
        g.height = height;
        g.pixelSize = {0, 1.2f / static_cast<float>(height)};
        g.position.ensure("test positions", GL_TEXTURE_2D, GL_RGBA32F, width, height);
        g.normal.ensure("test normals", GL_TEXTURE_2D, GL_RGBA16F, width, height);
        g.position.writeFloats(4, positions);
        g.normal.writeFloats(4, normals);
        return g;
    }
};

// Receivers of a G-buffer, as the shaders see them; nothing where there is no surface.
inline std::vector<std::optional<Receiver>> receiversOf(const GBuffer& g) {
    const auto p = g.position.readFloats(4), n = g.normal.readFloats(4);
    std::vector<std::optional<Receiver>> out(p.size() / 4);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (p[4 * i + 3] == 0) continue;
        const vec3 normal = normalize(vec3(n[4 * i], n[4 * i + 1], n[4 * i + 2]));
        out[i] = Receiver{{p[4 * i], p[4 * i + 1], p[4 * i + 2]}, unpackNormal(packNormal(normal))};
    }
    return out;
}

inline GpuViewMaps uploadMaps(const std::vector<std::uint32_t>& texels, int res,
                              std::uint32_t count, bool fused = true) {
    GpuViewMaps maps;
    maps.texels = {"test maps", texels};
    maps.mapRes = res;
    maps.mapCount = count;
    maps.fused = fused;
    maps.present = true;
    return maps;
}

// The same maps with 16 bits a texel.
inline GpuViewMaps packMaps(const GpuViewMaps& maps) {
    const std::vector<std::uint32_t> texels =
        maps.texels.read(0, mapWords(maps.store(), maps.mapCount));
    std::vector<std::uint32_t> words(texels.size() / 2);
    for (std::size_t i = 0; i < words.size(); ++i) {
        words[i] = packTexel(texels[2 * i]) | packTexel(texels[2 * i + 1]) << 16;
    }
    GpuViewMaps out = uploadMaps(words, maps.mapRes, maps.mapCount, maps.fused);
    out.packed = true;
    return out;
}

// One set of samples of views that have maps in their own tree.
inline void gatherOnce(GatherPass& pass, const GBuffer& gbuffer, const RootCube& root,
                       const GpuViewHierarchy& tree, const GpuViewMaps& maps,
                       const GatherOptions& options, gl::Profiler& profiler, GatherResult& out) {
    GatherRecords records;
    pass.prepare(gbuffer, tree, options, profiler);
    pass.record(tree, maps, nullptr, profiler, records);
    pass.gather({gbuffer, root, tree, maps, records, options}, profiler, out);
}

class GatherGpu : public ::testing::Test {
  public:
    // Kept between tests and calls, as the renderer does: shaders compile slowly.
    static GatherPass& pass() {
        if (!pass_) pass_ = std::make_unique<GatherPass>();
        return *pass_;
    }

  protected:
    void SetUp() override {
        if (!noContext.empty()) GTEST_SKIP() << "no OpenGL context: " << noContext;
    }
    static void SetUpTestSuite() {
        try {
            if (!context) context = std::make_unique<gl::HeadlessContext>();
            if (!room) room = std::make_unique<Room>();
        } catch (const Error& e) {
            noContext = e.what();
        }
    }
    static void TearDownTestSuite() {
        pass_.reset();
        room.reset();
        context.reset();
    }
    static inline std::unique_ptr<gl::HeadlessContext> context;
    static inline std::unique_ptr<Room> room;
    static inline std::string noContext;

  private:
    static inline std::unique_ptr<GatherPass> pass_;
};

}  // namespace mv::test
