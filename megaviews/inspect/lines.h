#pragma once
// What the instruments draw over the picture: straight lines in root-cube units, made on the CPU
// from copies of hierarchies and views (SceneHierarchy, ViewHierarchy, ViewSet -> Line), drawn by
// renderer/passes/overlay_pass.h. Colours are named here once, so that a legend can be made.

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "megaviews/hierarchy/view_hierarchy.h"
#include "shaders/shared/types.glsl"

namespace mv {

// RGBA8 sRGB, red in the lowest byte.
constexpr std::uint32_t rgba(std::uint32_t r, std::uint32_t g, std::uint32_t b,
                             std::uint32_t a = 255) {
    return r | g << 8 | b << 16 | a << 24;
}

struct Line {
    glm::vec3 a, b;  // root-cube units
    std::uint32_t colour;
    bool operator==(const Line&) const = default;
};
static_assert(sizeof(Line) == 28);

// The colours of Okabe and Ito, told apart with any colour vision.
inline constexpr std::uint32_t kOrange = rgba(230, 159, 0), kSkyBlue = rgba(86, 180, 233),
                               kGreen = rgba(0, 158, 115), kYellow = rgba(240, 228, 66),
                               kVermilion = rgba(213, 94, 0), kPurple = rgba(204, 121, 167),
                               kGrey = rgba(150, 150, 150);

inline constexpr std::uint32_t kSceneNodeColour = kVermilion;
inline constexpr std::uint32_t kViewNodeColour = kPurple;
inline constexpr std::uint32_t kConeColour = kYellow;
inline constexpr std::uint32_t kPickAColour = kOrange;
inline constexpr std::uint32_t kPickBColour = kSkyBlue;
inline constexpr std::uint32_t kSharedColour = kGreen;
inline constexpr std::uint32_t kPickedPairColour = rgba(255, 255, 255);

struct LegendEntry {
    std::string_view name;
    std::uint32_t colour;
};
std::span<const LegendEntry> decisionLegend();  // by kPair*, from kPairCulled on
std::span<const LegendEntry> sharingLegend();   // shared, A only, B only
std::uint32_t colourOfDecision(std::uint32_t decision);

// How many things there are and how many of them are drawn: when there are more than a cap, every
// n-th, evenly.
struct DrawnCount {
    std::uint64_t exist = 0, drawn = 0;
    bool operator==(const DrawnCount&) const = default;
};
inline constexpr std::uint64_t kMaxDrawnNodes = 10'000;
inline constexpr std::uint64_t kMaxDrawnViews = 65'536;

// Runs draw(i) for min(exist, cap) of the indices 0 .. exist - 1, in order and evenly spaced.
template <typename Draw>
DrawnCount drawEvenly(std::uint64_t exist, std::uint64_t cap, Draw&& draw) {
    const std::uint64_t drawn = exist < cap ? exist : cap;
    for (std::uint64_t k = 0; k < drawn; ++k) draw(k * exist / drawn);
    return {exist, drawn};
}

// The edges of a box; those without length are left out, and of equal edges all but one.
void appendBox(glm::vec3 center, glm::vec3 half, std::uint32_t colour, std::vector<Line>& lines);
// Three lines along the axes.
void appendCross(glm::vec3 center, float half, std::uint32_t colour, std::vector<Line>& lines);

// The boxes of a level's nodes, level 0 = root; nothing where the tree has no such level.
DrawnCount appendSceneLevel(std::span<const SceneNode> nodes,
                            std::span<const std::uint32_t> levelBegin, int level,
                            std::vector<Line>& lines, std::uint64_t cap = kMaxDrawnNodes);
// The same of the view octree, with the cone of each node's normals: its axis and rays on its
// mantle, or a cross where the views together see every direction.
DrawnCount appendViewLevel(const ViewHierarchy& views, int level, std::vector<Line>& lines,
                           std::uint64_t cap = kMaxDrawnNodes);
void appendCone(const ViewNode& node, std::uint32_t colour, std::vector<Line>& lines);

// Places, normals and flux of the living views: the line along the normal is as long as the cube
// root of the flux and has its hue; omnidirectional views are crosses.
DrawnCount appendViews(std::span<const View> views, std::vector<Line>& lines,
                       std::uint64_t cap = kMaxDrawnViews);
// One view, large.
void appendPickedView(const View& view, std::uint32_t colour, std::vector<Line>& lines);

}  // namespace mv
