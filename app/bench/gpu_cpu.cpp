#include "app/bench/gpu_cpu.h"

#include <algorithm>
#include <cmath>

#include "renderer/gl/context.h"

namespace mv {
namespace {

constexpr double kOtherDecisions = 1e-4;
constexpr double kOtherNodes = 0.01;

double allowedShare() { return gl::limits().software ? 0.0 : kOtherDecisions; }

bool near(float a, float b, float tolerance) { return std::abs(a - b) <= tolerance; }

bool sameNode(const ViewNode& a, const ViewNode& b) {
    constexpr float kLength = 1e-6f, kCone = 1e-3f;
    return a.children == b.children && a.level == b.level && a.firstView == b.firstView &&
           a.viewCount == b.viewCount && a.flags == b.flags &&
           near(a.centerX, b.centerX, kLength) && near(a.centerY, b.centerY, kLength) &&
           near(a.centerZ, b.centerZ, kLength) && near(a.halfX, b.halfX, kLength) &&
           near(a.halfY, b.halfY, kLength) && near(a.halfZ, b.halfZ, kLength) &&
           ((a.flags & kViewNodeNoCull) != 0 || near(a.cosPsi, b.cosPsi, kCone));
}

bool sameView(const View& a, const View& b) {
    constexpr float kPosition = 1e-5f, kNormal = 1e-3f;
    const float flux = 1e-3f * (std::abs(a.fluxR) + std::abs(a.fluxG) + std::abs(a.fluxB)) + 1e-37f;
    return a.flags == b.flags && a.slot == b.slot &&
           (a.flags == kViewDead ||
            (a.bounce == b.bounce && near(a.positionX, b.positionX, kPosition) &&
             near(a.positionY, b.positionY, kPosition) &&
             near(a.positionZ, b.positionZ, kPosition) && near(a.normalX, b.normalX, kNormal) &&
             near(a.normalY, b.normalY, kNormal) && near(a.normalZ, b.normalZ, kNormal) &&
             near(a.fluxR, b.fluxR, flux) && near(a.fluxG, b.fluxG, flux) &&
             near(a.fluxB, b.fluxB, flux)));
}

template <typename T, typename Same>
std::uint64_t countDifferent(std::span<const T> a, std::span<const T> b, const Same& same) {
    std::uint64_t different = a.size() == b.size() ? 0 : std::max(a.size(), b.size());
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) different += !same(a[i], b[i]);
    return different;
}

}  // namespace

std::uint64_t differingTexels(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
    return countDifferent(a, b, [](std::uint32_t x, std::uint32_t y) { return x == y; });
}

std::uint64_t differingViews(std::span<const View> a, std::span<const View> b) {
    return countDifferent(a, b, sameView);
}

std::uint64_t differingNodes(std::span<const ViewNode> a, std::span<const ViewNode> b) {
    return countDifferent(a, b, sameNode);
}

bool pairsAgree(const PairCounts& gpu, const PairCounts& cpu) {
    if (gl::limits().software) return gpu == cpu;
    const double gap =
        std::abs(static_cast<double>(gpu.processed) - static_cast<double>(cpu.processed));
    return gap <= allowedShare() * std::max(1.0, static_cast<double>(cpu.processed));
}

bool nodesAgree(std::uint64_t different, std::uint64_t nodes) {
    return static_cast<double>(different) <=
           (gl::limits().software ? 0.0 : kOtherNodes) * static_cast<double>(nodes);
}

bool texelsAgree(std::uint64_t different, std::uint64_t texels) {
    return static_cast<double>(different) <= allowedShare() * static_cast<double>(texels);
}

}  // namespace mv
