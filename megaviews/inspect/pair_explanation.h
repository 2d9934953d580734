#pragma once
// Why a pair of scene and view node was decided as it was [Kol19 §3.2]: the comparisons that
// shaders/shared/pair.glsl made, in their order, with both of their numbers.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "megaviews/methods/megaviews/pairs.h"

namespace mv {

// How two numbers compared: "size, texels", 0.81 < 2.
struct PairComparison {
    std::string_view what;
    double value = 0;
    std::string_view relation;  // "<", ">", "<=", ">=": the one that holds
    double limit = 0;
};
struct PairExplanation {
    NodePair pair{};
    std::vector<PairComparison> comparisons;  // the last one decided
    std::string reason;                       // a sentence with its numbers
};

// sceneNodes must be those of settings.rules; both indices must be in range.
PairExplanation explainPair(std::span<const SceneNode> sceneNodes,
                            std::span<const ViewNode> viewNodes, const MethodSettings& settings,
                            std::uint32_t scene, std::uint32_t view);

// "node 12, level 4, a leaf", or that there is none.
std::string sceneNodeText(std::span<const SceneNode> nodes, std::int64_t node);
std::string viewNodeText(std::span<const ViewNode> nodes, std::int64_t node);

// The size that is compared with the threshold, in texels; infinite where nothing bounds it.
double projectedTexels(const SceneNode& scene, const ViewNode& view,
                       const MethodSettings& settings);

}  // namespace mv
