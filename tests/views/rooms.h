#pragma once
// Small closed rooms with furniture, lights and materials of every kind, for the tests of VPLs.

#include <glm/gtc/constants.hpp>
#include <random>

#include "megaviews/views/view_set.h"

namespace mv::testing {

// Collects quads in world units; finish() brings them into the root cube.
class RoomBuilder {
  public:
    RoomBuilder() { scene_.name = "test room"; }

    int material(glm::vec3 albedo, glm::vec3 emission = glm::vec3(0)) {
        Material m;
        m.baseColor = glm::vec4(albedo, 1);
        m.emission = emission;
        return material(m);
    }
    int material(const Material& m) {
        scene_.materials.push_back(m);
        return static_cast<int>(scene_.materials.size()) - 1;
    }
    // An RGBA8 image of width * height texels and a texture of it.
    int texture(int width, int height, std::vector<std::uint8_t> rgba) {
        scene_.images.push_back({"test", width, height, std::move(rgba)});
        scene_.textures.push_back(
            {static_cast<int>(scene_.images.size()) - 1, Wrap::repeat, Wrap::repeat, false});
        return static_cast<int>(scene_.textures.size()) - 1;
    }
    // Corner a, edges u and v; the front looks along u x v.
    void quad(glm::dvec3 a, glm::dvec3 u, glm::dvec3 v, int material) {
        const auto first = static_cast<std::uint32_t>(world_.size());
        for (const glm::dvec2 uv : {glm::dvec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            world_.push_back(a + uv.x * u + uv.y * v);
            scene_.normals.push_back(glm::vec3(glm::normalize(glm::cross(u, v))));
            scene_.uvs.push_back(glm::vec2(uv));
            scene_.emissiveUvs.push_back(glm::vec2(uv));
        }
        for (const glm::uvec3 t : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
            scene_.triangles.push_back(first + t);
            scene_.triangleMaterials.push_back(static_cast<std::uint32_t>(material));
        }
    }
    // Six faces looking outwards, or inwards for a room.
    void box(glm::dvec3 low, glm::dvec3 high, int material, bool inwards = false) {
        const glm::dvec3 size = high - low;
        const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
        const auto face = [&](glm::dvec3 a, glm::dvec3 u, glm::dvec3 v) {
            if (inwards) {
                quad(a, v, u, material);
            } else {
                quad(a, u, v, material);
            }
        };
        face(low, y, x);
        face(low, x, z);
        face(low, z, y);
        face(low + z, x, y);
        face(low + y, z, x);
        face(low + x, y, z);
    }
    void light(LightType type, glm::dvec3 position, glm::dvec3 direction, glm::vec3 intensity,
               double innerConeRad = 0, double outerConeRad = 0.8) {
        Light l;
        l.type = type;
        l.intensity = intensity;
        l.innerConeRad = innerConeRad;
        l.outerConeRad = outerConeRad;
        l.node = static_cast<int>(scene_.nodes.size());
        scene_.lights.push_back(l);
        const glm::dvec3 back = -glm::normalize(direction);
        const glm::dvec3 any = std::abs(back.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
        const glm::dvec3 right = glm::normalize(glm::cross(any, back));
        Node node;
        node.matrix = glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0),
                                 glm::dvec4(back, 0), glm::dvec4(position, 1));
        scene_.nodes.push_back(node);
    }
    Scene finish() {
        glm::dvec3 low(1e300), high(-1e300);
        for (const glm::dvec3& p : world_) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        scene_.root = RootCube::around(low, high);
        for (const glm::dvec3& p : world_) scene_.positions.push_back(scene_.root.rootFromWorld(p));
        if (scene_.textures.empty()) {
            scene_.uvs.clear();
            scene_.emissiveUvs.clear();
        }
        if (scene_.materials.empty()) scene_.materials.push_back({});
        return std::move(scene_);
    }

  private:
    Scene scene_;
    std::vector<glm::dvec3> world_;
};

// A closed room of 4 x 3 x 5 m, every surface of one albedo, no light yet.
inline RoomBuilder whiteRoom(float albedo = 1) {
    RoomBuilder room;
    room.box({0, 0, 0}, {4, 3, 5}, room.material(glm::vec3(albedo)), true);
    return room;
}

// The kinds of light a furnished room can have.
enum Lighting { point = 1, spot = 2, sun = 4, panel = 8, everything = 15 };

// A room 30 m from the origin with coloured walls, boxes at random, a picture on a wall, a masked
// screen and a window in the ceiling that lets some paths out.
inline Scene furnishedRoom(std::uint32_t seed, int lighting) {
    std::mt19937 random(seed);
    const auto uniform = [&] { return static_cast<double>(random() >> 8) / 16777216.0; };
    const glm::dvec3 o(30, -20, 10);
    RoomBuilder room;
    const int red = room.material({0.7f, 0.2f, 0.1f}), blue = room.material({0.1f, 0.3f, 0.8f});
    const int grey = room.material({0.6f, 0.6f, 0.6f}), black = room.material(glm::vec3(0));
    std::vector<std::uint8_t> checker, holes;
    for (int i = 0; i < 16; ++i) {
        const bool odd = ((i ^ (i >> 2)) & 1) != 0;
        const std::uint8_t c = odd ? 255 : 60;
        checker.insert(checker.end(), {c, c, static_cast<std::uint8_t>(255 - c), 255});
        holes.insert(holes.end(), {200, 220, 200, static_cast<std::uint8_t>(odd ? 255 : 0)});
    }
    Material picture;
    picture.baseTexture = room.texture(4, 4, checker);
    Material screen;
    screen.baseTexture = room.texture(4, 4, holes);
    screen.alphaCutoff = 0.5f;
    const int pictureId = room.material(picture), screenId = room.material(screen);

    const glm::dvec3 x(4, 0, 0), y(0, 3, 0), z(0, 0, 5);
    room.quad(o, z, x, grey);            // floor
    room.quad(o + y, x * 0.8, z, grey);  // ceiling, open at one side
    room.quad(o, y, z, red);
    room.quad(o + x, z, y, blue);
    room.quad(o, x, y, pictureId);
    room.quad(o + z, y, x, grey);
    room.quad(o + glm::dvec3(0.5, 0, 2.5), x * 0.7, y * 0.8, screenId);
    room.quad(o + glm::dvec3(1, 0.001, 1), z * 0.1, x * 0.1, black);
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 low = o + glm::dvec3(3 * uniform(), 1.5 * uniform(), 4 * uniform());
        const glm::dvec3 size(0.2 + 0.6 * uniform(), 0.2 + 0.6 * uniform(), 0.2 + 0.6 * uniform());
        room.box(low, low + size, i % 2 ? red : grey);
    }
    if (lighting & point) {
        room.light(LightType::point, o + glm::dvec3(1, 2.7, 1), {0, -1, 0}, {5, 4, 3});
    }
    if (lighting & spot) {
        room.light(LightType::spot, o + glm::dvec3(3, 2.5, 4.5), {-1, -0.6, -2}, {3, 9, 4}, 0.3,
                   0.7);
    }
    if (lighting & sun) {
        room.light(LightType::directional, o, {-0.4, -1, 0.1}, {2, 2, 1.5});
    }
    if (lighting & panel) {
        // A one-sided panel, a double-sided one with a texture, and an unlit one.
        room.quad(o + glm::dvec3(1, 2.9, 3), x * 0.2, z * 0.2,
                  room.material({0.5f, 0.5f, 0.5f}, {9, 8, 7}));
        Material lamp;
        lamp.baseColor = {0.3f, 0.3f, 0.3f, 1};
        lamp.emission = {2, 3, 6};
        lamp.emissiveTexture = picture.baseTexture;
        lamp.doubleSided = true;
        room.quad(o + glm::dvec3(0.2, 1, 0.3), x * 0.15, y * 0.3, room.material(lamp));
        Material unlit;
        unlit.baseColor = {0.9f, 0.5f, 0.1f, 1};
        unlit.unlit = true;
        room.quad(o + glm::dvec3(3.9, 1, 1), z * 0.2, y * 0.2, room.material(unlit));
    }
    return room.finish();
}

// A scene with what hangs on its address; lights stand still.
struct Lit {
    Scene scene;
    TriangleBvh bvh;
    Emitters emitters;
    explicit Lit(Scene s, double lightScale = 1, const Environment& environment = {})
        : scene(std::move(s)) {
        bvh = TriangleBvh::build(scene);
        emitters = makeEmitters(scene, bvh, {.scale = lightScale, .environment = environment});
    }
    Lit(const Lit&) = delete;
    Lit& operator=(const Lit&) = delete;
    ViewSet trace(std::uint64_t count, int bounces, std::uint32_t seed = 0) const {
        return traceVpls(bvh, emitters, {count, bounces, seed});
    }
};

inline glm::dvec3 fluxOf(const View& v) { return {v.fluxR, v.fluxG, v.fluxB}; }
inline glm::dvec3 positionOf(const View& v) { return {v.positionX, v.positionY, v.positionZ}; }
inline glm::dvec3 normalOf(const View& v) { return {v.normalX, v.normalY, v.normalZ}; }

}  // namespace mv::testing
