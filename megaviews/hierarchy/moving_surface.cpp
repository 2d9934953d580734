#include "megaviews/hierarchy/moving_surface.h"

#include <algorithm>
#include <span>
#include <vector>

namespace mv {

namespace {

// A piece as its triangle stands.
Fragment fragmentOf(const Scene& scene, const MovingPiece& piece,
                    std::span<const glm::vec2> corners) {
    const glm::uvec3 c = scene.triangles[piece.triangle];
    const glm::dvec3 a(scene.positions[c.x]);
    const glm::dvec3 b = glm::dvec3(scene.positions[c.y]) - a;
    const glm::dvec3 d = glm::dvec3(scene.positions[c.z]) - a;
    const glm::dvec3 n = glm::cross(b, d);
    const double twice = glm::length(n);
    const auto place = [&](glm::vec2 w) { return a + double{w.x} * b + double{w.y} * d; };

    // In the triangle's own plane areas are to each other as they are in its weights.
    Fragment f{};
    f.lo = glm::dvec3(1e300);
    f.hi = glm::dvec3(-1e300);
    double share = 0;
    glm::dvec2 middle(0), mean(0);
    const glm::dvec2 origin(corners[0]);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 p = place(corners[i]);
        f.lo = glm::min(f.lo, p);
        f.hi = glm::max(f.hi, p);
        mean += glm::dvec2(corners[i]);
        if (i + 1 == corners.size()) break;
        const glm::dvec2 u = glm::dvec2(corners[i]) - origin;
        const glm::dvec2 v = glm::dvec2(corners[i + 1]) - origin;
        const double fan = u.x * v.y - u.y * v.x;
        share += fan;
        middle += fan * (u + v) / 3.0;
    }
    mean /= static_cast<double>(corners.size());
    const glm::dvec2 centre = share > 0 ? origin + middle / share : mean;
    f.centroid = place(glm::vec2(centre));
    f.faceNormal = twice > 0 ? n / twice : glm::dvec3(0);
    f.area = 0.5 * twice * std::max(share, 0.0) * double{piece.coverage};
    return f;
}

}  // namespace

SurfaceSums MovingSurface::sumsOf(const Scene& scene, std::size_t leaf) const {
    std::vector<Fragment> fragments;
    for (std::uint32_t i = pieces[leaf]; i < pieces[leaf + 1]; ++i) {
        const MovingPiece& piece = all[i];
        fragments.push_back(
            fragmentOf(scene, piece, std::span(corners).subspan(piece.firstCorner, piece.corners)));
    }
    // What has no size is where nothing is seen of it, perhaps far from the rest.
    const auto isFlat = [](const Fragment& f) { return !(f.area > 0); };
    if (!std::ranges::all_of(fragments, isFlat)) std::erase_if(fragments, isFlat);
    return SurfaceSums::ofFragments(fragments);
}

}  // namespace mv
