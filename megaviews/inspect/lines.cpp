#include "megaviews/inspect/lines.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shaders/shared/light.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {
namespace {

constexpr int kConeRays = 12;

constexpr LegendEntry kDecisionLegend[] = {
    {"culled", kGrey},        {"rendered", kGreen},     {"forced", kVermilion},
    {"split scene", kOrange}, {"split view", kSkyBlue}, {"skipped", kYellow},
};
constexpr LegendEntry kSharingLegend[] = {
    {"shared", kSharedColour}, {"A only", kPickAColour}, {"B only", kPickBColour}};

// Two unit vectors that make an orthonormal basis with a unit axis.
std::array<vec3, 2> across(vec3 axis) {
    const vec3 any = std::abs(axis.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 u = normalizeOr(cross3(axis, any), vec3(0, 0, 1));
    return {u, cross3(axis, u)};
}

// The flux's hue at full brightness; a little grey so that pure colours stay visible.
std::uint32_t hueOf(vec3 flux) {
    const float most = std::max({flux.x, flux.y, flux.z});
    if (!(most > 0)) return kGrey;
    std::array<std::uint32_t, 3> c{};
    for (int i = 0; i < 3; ++i) {
        const float linear = 0.05f + 0.95f * std::max(flux[i], 0.0f) / most;
        c[static_cast<std::size_t>(i)] =
            static_cast<std::uint32_t>(std::lround(255 * std::pow(linear, 1 / 2.2f)));
    }
    return rgba(c[0], c[1], c[2]);
}

DrawnCount appendLevel(std::span<const std::uint32_t> levelBegin, int level, std::uint64_t cap,
                       auto&& draw) {
    if (level < 0 || static_cast<std::size_t>(level) + 1 >= levelBegin.size()) return {};
    const std::uint32_t begin = levelBegin[static_cast<std::size_t>(level)];
    const std::uint32_t end = levelBegin[static_cast<std::size_t>(level) + 1];
    return drawEvenly(end - begin, cap, [&](std::uint64_t i) { draw(begin + i); });
}

}  // namespace

std::span<const LegendEntry> decisionLegend() { return kDecisionLegend; }
std::span<const LegendEntry> sharingLegend() { return kSharingLegend; }

std::uint32_t colourOfDecision(std::uint32_t decision) {
    static_assert(kPairCulled == 1 && kPairSkipped == 6 && std::size(kDecisionLegend) == 6);
    return decision >= kPairCulled && decision <= kPairSkipped
               ? kDecisionLegend[decision - kPairCulled].colour
               : kGrey;
}

void appendBox(glm::vec3 center, glm::vec3 half, std::uint32_t colour, std::vector<Line>& lines) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(half[axis] > 0)) continue;
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int corner = 0; corner < 4; ++corner) {
            if ((corner & 1) != 0 && !(half[u] > 0)) continue;
            if ((corner & 2) != 0 && !(half[v] > 0)) continue;
            vec3 a = center;
            a[u] += (corner & 1) != 0 ? half[u] : -half[u];
            a[v] += (corner & 2) != 0 ? half[v] : -half[v];
            vec3 b = a;
            a[axis] -= half[axis];
            b[axis] += half[axis];
            lines.push_back({a, b, colour});
        }
    }
}

void appendCross(glm::vec3 center, float half, std::uint32_t colour, std::vector<Line>& lines) {
    for (int axis = 0; axis < 3; ++axis) {
        vec3 d(0);
        d[axis] = half;
        lines.push_back({center - d, center + d, colour});
    }
}

DrawnCount appendSceneLevel(std::span<const SceneNode> nodes,
                            std::span<const std::uint32_t> levelBegin, int level,
                            std::vector<Line>& lines, std::uint64_t cap) {
    return appendLevel(levelBegin, level, cap, [&](std::uint64_t i) {
        appendBox(boxCenter(nodes[i]), boxHalf(nodes[i]), kSceneNodeColour, lines);
    });
}

void appendCone(const ViewNode& node, std::uint32_t colour, std::vector<Line>& lines) {
    const vec3 apex = boxCenter(node);
    const float cell = 1.0f / static_cast<float>(1u << std::min(node.level, 10u));
    const float length = std::clamp(0.6f * cell, 0.008f, 0.1f);
    if ((node.flags & kViewNodeNoCull) != 0) {
        appendCross(apex, 0.5f * length, colour, lines);
        return;
    }
    const vec3 axis = axisOf(node);
    lines.push_back({apex, apex + axis * length, colour});
    // psi = cone of normals + 90 degrees
    const float cosTheta = node.sinPsi, sinTheta = -node.cosPsi;
    if (!(sinTheta > 1e-3f)) return;  // one direction: the axis shows it
    const auto [u, v] = across(axis);
    vec3 before(0);
    for (int k = 0; k <= kConeRays; ++k) {
        const float phi = 2 * kPi * static_cast<float>(k % kConeRays) / kConeRays;
        const vec3 ray = axis * cosTheta + (u * cos(phi) + v * sin(phi)) * sinTheta;
        const vec3 tip = apex + ray * length;
        if (k > 0) lines.push_back({before, tip, colour});
        if (k < kConeRays && k % 3 == 0) lines.push_back({apex, tip, colour});
        before = tip;
    }
}

DrawnCount appendViewLevel(const ViewHierarchy& views, int level, std::vector<Line>& lines,
                           std::uint64_t cap) {
    return appendLevel(views.levelBegin, level, cap, [&](std::uint64_t i) {
        const ViewNode& node = views.nodes[i];
        appendBox(boxCenter(node), boxHalf(node), kViewNodeColour, lines);
        appendCone(node, kConeColour, lines);
    });
}

DrawnCount appendViews(std::span<const View> views, std::vector<Line>& lines, std::uint64_t cap) {
    std::vector<std::uint32_t> alive;
    float brightest = 0;
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].flags == kViewDead) continue;
        alive.push_back(static_cast<std::uint32_t>(i));
        brightest = std::max(brightest, luminance(viewFlux(views[i])));
    }
    // About as long as the distance between them.
    const auto drawn = static_cast<float>(std::min<std::uint64_t>(alive.size(), cap));
    const float longest = std::clamp(1.5f / std::sqrt(std::max(drawn, 1.0f)), 0.01f, 0.05f);
    return drawEvenly(alive.size(), cap, [&](std::uint64_t i) {
        const View& view = views[alive[i]];
        const vec3 at = viewPosition(view), normal = viewNormal(view), flux = viewFlux(view);
        const float share = brightest > 0 ? std::max(luminance(flux), 0.0f) / brightest : 0.0f;
        const float length = longest * std::max(0.15f, std::cbrt(share));
        const std::uint32_t colour = hueOf(flux);
        if (view.flags == kViewOmnidirectional) {
            appendCross(at, 0.35f * length, colour, lines);
            return;
        }
        for (const vec3& d : across(normal)) {
            lines.push_back({at - d * (0.1f * longest), at + d * (0.1f * longest), colour});
        }
        lines.push_back({at, at + normal * length, colour});
    });
}

void appendPickedView(const View& view, std::uint32_t colour, std::vector<Line>& lines) {
    const vec3 at = viewPosition(view);
    appendCross(at, 0.02f, colour, lines);
    appendBox(at, vec3(0.008f), colour, lines);
    if (view.flags != kViewHemisphere) return;
    // An arrow along the normal.
    const vec3 normal = viewNormal(view), tip = at + normal * 0.08f;
    lines.push_back({at, tip, colour});
    for (const vec3& d : across(normal)) {
        for (const float side : {-0.01f, 0.01f}) {
            lines.push_back({tip, tip - normal * 0.02f + d * side, colour});
        }
    }
}

}  // namespace mv
