#pragma once
// What the tests of the baselines share: views at given points, one map each, and maps compared
// with rays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gl/gl_fixture.h"
#include "megaviews/hierarchy/view_hierarchy.h"
#include "megaviews/references/exact_maps.h"
#include "renderer/passes/view_hierarchy_pass.h"
#include "scene/bvh_test_scene.h"
#include "shaders/shared/paraboloid.glsl"
#include "views/rooms.h"

namespace mv::testing {

// A leaf for each view, as the renderer makes it for methods that share nothing.
inline ViewHierarchy flatHierarchy(const std::vector<View>& views) {
    return ViewHierarchy::build(views, {.levels = 6, .flat = true});
}

inline std::vector<View> viewsAt(const std::vector<vec3>& positions) {
    std::vector<View> out;
    for (const vec3& p : positions) {
        View view{};
        view.positionX = p.x;
        view.positionY = p.y;
        view.positionZ = p.z;
        view.flags = kViewOmnidirectional;
        view.slot = static_cast<uint>(out.size());
        out.push_back(view);
    }
    return out;
}

inline std::vector<vec3> positionsOf(const std::vector<View>& views) {
    std::vector<vec3> out;
    for (const View& v : views) out.emplace_back(v.positionX, v.positionY, v.positionZ);
    return out;
}

inline std::vector<vec3> randomPoints(std::uint32_t seed, std::size_t count) {
    Random random(seed);
    std::vector<vec3> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(random.point());
    return out;
}

// Triangles by their corners, and what holds them.
struct Soup {
    Scene scene;
    TriangleBvh bvh;
    explicit Soup(std::vector<vec3> corners) : scene(soupScene(corners)) {
        bvh = TriangleBvh::build(scene);
    }
    Soup(Soup&&) = delete;
};

}  // namespace mv::testing
