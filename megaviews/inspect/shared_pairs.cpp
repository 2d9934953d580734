#include "megaviews/inspect/shared_pairs.h"

#include <algorithm>

namespace mv {
namespace {

void appendRendered(const ViewPairs& from, std::size_t begin, std::size_t end,
                    std::vector<NodePair>& to) {
    std::copy_if(from.pairs.begin() + static_cast<std::ptrdiff_t>(from.chainBegin[begin]),
                 from.pairs.begin() + static_cast<std::ptrdiff_t>(from.chainBegin[end]),
                 std::back_inserter(to), isRendered);
}

}  // namespace

SharedPairs sharedPairs(const ViewPairs& a, const ViewPairs& b) {
    // Chains from the same root run together until the views part.
    const auto parted =
        std::mismatch(a.chain.begin(), a.chain.end(), b.chain.begin(), b.chain.end());
    const auto common = static_cast<std::size_t>(parted.first - a.chain.begin());
    SharedPairs out;
    appendRendered(a, 0, common, out.both);
    appendRendered(a, common, a.chain.size(), out.aAlone);
    appendRendered(b, common, b.chain.size(), out.bAlone);
    return out;
}

DrawnCount appendSharedPairs(const SharedPairs& shared, std::span<const SceneNode> sceneNodes,
                             std::vector<Line>& lines, std::uint64_t cap) {
    DrawnCount sum;
    // A little inside each other, so that boxes of both alone do not hide each other.
    const auto append = [&](const std::vector<NodePair>& pairs, std::uint32_t colour, float size) {
        const DrawnCount count = drawEvenly(pairs.size(), cap, [&](std::uint64_t i) {
            const SceneNode& node = sceneNodes[pairs[i].scene];
            appendBox(boxCenter(node), boxHalf(node) * size, colour, lines);
        });
        sum.exist += count.exist;
        sum.drawn += count.drawn;
    };
    append(shared.aAlone, kPickAColour, 0.98f);
    append(shared.bAlone, kPickBColour, 0.92f);
    append(shared.both, kSharedColour, 1);
    return sum;
}

}  // namespace mv
