#include "megaviews/methods/rays/march_tree.h"

#include <algorithm>
#include <cmath>

#include "shaders/shared/pair.glsl"
#include "shaders/shared/surface.glsl"

namespace mv {
namespace {

uint packRange(float center, float half) {
    const double grid{kMarchGrid};
    const double low = std::floor((double{center} - double{half}) * grid);
    const double high = std::ceil((double{center} + double{half}) * grid);
    return static_cast<uint>(std::clamp(low, 0.0, grid)) |
           static_cast<uint>(std::clamp(high, 0.0, grid)) << 16;
}

uint packCoordinate(double value, double scale, double zero) {
    return static_cast<uint>(std::lround(value * scale + zero));
}

// What stands in a leaf's last word.
uint packLeaf(const SceneNode& node, glm::uvec4 box) {
    if (!surfaceUsable(node.surface)) return kMarchLeaf;
    const glm::dvec2 p(octahedralPoint(surfaceNormal(node.surface)));
    uint word = kMarchLeaf | kMarchPlane |
                packCoordinate(p.x, double{kMarchNormalScale}, double{kMarchNormalScale}) << 8 |
                packCoordinate(p.y, double{kMarchNormalScale}, double{kMarchNormalScale}) << 19;
    // The height over the centre of the rounded box, along the rounded normal.
    const glm::dvec3 packed(marchPlaneNormal(word));
    const glm::dvec3 low(box.x & 0xFFFF, box.y & 0xFFFF, box.z & 0xFFFF);
    const glm::dvec3 high(box.x >> 16, box.y >> 16, box.z >> 16);
    const glm::dvec3 point = glm::dvec3(centroidOf(node)) * double{kMarchGrid};
    const double reach = glm::dot(glm::abs(packed), (high - low) * 0.5);
    const double height = glm::dot(packed, point - (low + high) * 0.5);
    const double share = reach > 0 ? std::clamp(height / reach, -1.0, 1.0) : 0.0;
    return word | packCoordinate(share, double{kMarchHeightScale}, 128);
}

void append(const SceneHierarchy& scene, uint index, std::vector<glm::uvec4>& out) {
    const SceneNode& node = scene.nodes[index];
    const std::size_t at = out.size();
    out.emplace_back(packRange(node.centerX, node.halfX), packRange(node.centerY, node.halfY),
                     packRange(node.centerZ, node.halfZ), 0u);
    if (node.children == 0) {
        out[at].w = packLeaf(node, out[at]);
        return;
    }
    for (uint child = 0; child < childCountOf(node.children); ++child) {
        append(scene, firstChildOf(node.children) + child, out);
    }
    out[at].w = static_cast<uint>(out.size());
}

}  // namespace

MarchTree MarchTree::build(const SceneHierarchy& scene) {
    MarchTree tree;
    if (scene.nodes.empty()) return tree;
    tree.leafEdge = scene.leafEdge();
    tree.nodes.reserve(scene.nodes.size());
    append(scene, 0, tree.nodes);
    return tree;
}

MarchNodes MarchTree::data() const {
    return {nodes.data(), static_cast<uint>(nodes.size()), leafEdge};
}

bool MarchTree::blocked(glm::vec3 receiver, glm::vec3 normal, glm::vec3 view,
                        glm::vec3 viewNormal) const {
    uint steps = 0;
    return marchBlocked(data(), receiver, normal, view, viewNormal, kNone - 1, steps);
}

}  // namespace mv
