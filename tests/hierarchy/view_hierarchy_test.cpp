#include "megaviews/hierarchy/view_hierarchy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "hierarchy/test_scenes.h"
#include "hierarchy/test_views.h"
#include "shaders/shared/cone.glsl"
#include "shaders/shared/morton.glsl"
#include "shaders/shared/pair.glsl"

namespace mv {
namespace {

using test::angle;
using test::makeView;
using test::makeViews;
using test::viewKinds;

glm::vec3 positionOf(const View& v) { return {v.positionX, v.positionY, v.positionZ}; }
glm::vec3 normalOf(const View& v) { return {v.normalX, v.normalY, v.normalZ}; }

// Everything the header promises, checked node by node and view by view.
void expectHierarchy(const std::vector<View>& views, const ViewHierarchyOptions& options) {
    const ViewHierarchy h = ViewHierarchy::build(views, options);
    const auto n = static_cast<std::uint32_t>(h.sortedViews.size());
    const auto leafLevel = static_cast<std::uint32_t>(options.levels - 1);

    // All alive views, by (key, slot).
    ASSERT_EQ(n, std::count_if(views.begin(), views.end(),
                               [](const View& v) { return v.flags != kViewDead; }));
    for (std::uint32_t i = 0; i < n; ++i) {
        ASSERT_EQ(h.mortonKeys[i], mortonKeyOf(positionOf(h.sortedViews[i])));
        ASSERT_EQ(h.sortedViews[i].fluxR, views[h.sortedViews[i].slot].fluxR);
        if (i == 0) continue;
        ASSERT_LE(h.mortonKeys[i - 1], h.mortonKeys[i]);
        ASSERT_TRUE(h.mortonKeys[i - 1] < h.mortonKeys[i] ||
                    h.sortedViews[i - 1].slot < h.sortedViews[i].slot);
    }
    ASSERT_EQ(h.empty(), n == 0);
    ASSERT_EQ(h.nodes.size(), h.mapOfNode.size());
    ASSERT_EQ(h.leafOfView.size(), n);
    if (options.flat) {
        ASSERT_EQ(h.levelBegin, (std::vector<std::uint32_t>{0, n}));
    } else {
        ASSERT_EQ(h.levelBegin.size(), static_cast<std::size_t>(options.levels) + 1);
        ASSERT_EQ(h.levelBegin.front(), 0u);
    }
    ASSERT_EQ(h.levelBegin.back(), h.nodes.size());
    ASSERT_EQ(h.nodes.empty() ? 0 : h.levelBegin[1] - h.levelBegin[0],
              options.flat ? n : std::min(n, 1u));

    std::uint32_t leaves = 0;
    std::vector<std::uint32_t> viewOfMap(h.leafCount, kNone);
    std::vector<std::uint32_t> covered(n, 0);
    for (std::uint32_t k = 0; k < h.nodes.size(); ++k) {
        const ViewNode& node = h.nodes[k];
        SCOPED_TRACE(k);
        ASSERT_GE(k, h.levelBegin[node.level]);
        ASSERT_LT(k, h.levelBegin[node.level + 1]);
        ASSERT_GE(node.viewCount, 1u);
        ASSERT_LE(node.firstView + node.viewCount, n);
        // The views of the node are those of its cell.
        const std::uint32_t shift = 3 * (kMortonLevels - node.level);
        const std::uint32_t key = h.mortonKeys[node.firstView] >> shift;
        const std::uint32_t end = node.firstView + node.viewCount;
        if (!options.flat) {
            ASSERT_EQ(h.mortonKeys[end - 1] >> shift, key);
            ASSERT_TRUE(node.firstView == 0 || h.mortonKeys[node.firstView - 1] >> shift != key);
            ASSERT_TRUE(end == n || h.mortonKeys[end] >> shift != key);
        }
        // Family.
        const bool isLeaf = node.children == 0;
        ASSERT_EQ(isLeaf, options.flat || node.level == leafLevel ||
                              (hasRule(options.rules, kRuleLoneViews) && node.viewCount == 1));
        ASSERT_EQ(isLeaf, h.mapOfNode[k] != kNone);
        if (isLeaf) {
            ++leaves;
            ASSERT_LT(h.mapOfNode[k], h.leafCount);
            viewOfMap[h.mapOfNode[k]] = node.firstView;
            for (std::uint32_t i = node.firstView; i < end; ++i) {
                ASSERT_EQ(h.leafOfView[i], k);
                ++covered[i];
            }
        } else {
            std::uint32_t next = node.firstView;
            for (std::uint32_t c = 0; c < childCountOf(node.children); ++c) {
                const std::uint32_t child = firstChildOf(node.children) + c;
                ASSERT_EQ(h.nodes[child].level, node.level + 1);
                ASSERT_EQ(h.nodes[child].firstView, next);
                ASSERT_EQ(parentOf(h.nodes[child]), k);
                next += h.nodes[child].viewCount;
            }
            ASSERT_EQ(next, end);
        }
        if (node.level == 0) {
            ASSERT_EQ(parentOf(node), kNone);
        }
        // Box.
        glm::vec3 lo(1e9f), hi(-1e9f);
        for (std::uint32_t i = node.firstView; i < end; ++i) {
            lo = glm::min(lo, positionOf(h.sortedViews[i]));
            hi = glm::max(hi, positionOf(h.sortedViews[i]));
        }
        if (!hasRule(options.rules, kRuleBoxes) && !options.flat) {
            ASSERT_EQ(boxCenter(node), cellCenter(key, node.level));
            ASSERT_EQ(boxHalf(node), glm::vec3(cellHalf(node.level)));
        } else {
            for (std::uint32_t i = node.firstView; i < end; ++i)
                ASSERT_TRUE(glm::all(glm::lessThanEqual(
                    glm::abs(positionOf(h.sortedViews[i]) - boxCenter(node)), boxHalf(node))));
            ASSERT_TRUE(
                glm::all(glm::lessThanEqual(boxHalf(node), 0.5f * (hi - lo) * 1.000001f + 1e-7f)));
            if (lo == hi) {
                ASSERT_EQ(boxHalf(node), glm::vec3(0));
            }
        }
        // Cone: every direction within psi - pi/2 of the axis.
        const glm::vec3 axis(node.axisX, node.axisY, node.axisZ);
        ASSERT_NEAR(glm::length(axis), 1, 1e-6);
        bool omnidirectional = false;
        for (std::uint32_t i = node.firstView; i < end; ++i)
            omnidirectional |= h.sortedViews[i].flags == kViewOmnidirectional;
        if (omnidirectional) {
            ASSERT_TRUE(node.flags & kViewNodeNoCull);
        }
        if (node.flags & kViewNodeNoCull) {
            ASSERT_EQ(node.cosPsi, -1);
            continue;
        }
        ASSERT_NEAR(node.cosPsi * node.cosPsi + node.sinPsi * node.sinPsi, 1, 1e-6);
        const double theta = std::atan2(-double{node.cosPsi}, double{node.sinPsi});
        ASSERT_GE(theta, 0);
        ASSERT_LT(theta, 1.5707964);
        double widest = 0;
        for (std::uint32_t i = node.firstView; i < end; ++i)
            widest = std::max(widest, angle(axis, normalOf(h.sortedViews[i])));
        if (node.viewCount == 1) {
            ASSERT_EQ(theta, 0);
            ASSERT_EQ(axis, normalOf(h.sortedViews[node.firstView]));
        } else {
            ASSERT_LE(widest, theta);
            // Not wider than what merging its levels one by one can cost.
            if (isLeaf) {
                ASSERT_LT(theta, widest * (node.viewCount > kViewBlock ? 2 : 1) + 1e-5);
            }
        }
    }
    ASSERT_EQ(leaves, h.leafCount);
    // Maps lie in the order of the views, so that a run of views has a run of maps.
    ASSERT_TRUE(std::is_sorted(viewOfMap.begin(), viewOfMap.end(), std::less_equal<>()) ||
                viewOfMap.size() < 2);
    ASSERT_EQ(std::count(viewOfMap.begin(), viewOfMap.end(), kNone), 0);
    ASSERT_EQ(std::count(covered.begin(), covered.end(), 1u), n);
}

TEST(ViewHierarchy, keepsItsPromisesForEveryKindOfViews) {
    for (const std::string& kind : viewKinds())
        for (const std::size_t count : {0u, 1u, 2u, 3u, 7u, 64u, 1000u})
            for (const int levels : {1, 2, 5, 10, 11})
                for (const int mode : {0, 1, 2}) {
                    SCOPED_TRACE(kind + ", " + std::to_string(count) + " views, " +
                                 std::to_string(levels) + " levels, mode " + std::to_string(mode));
                    expectHierarchy(makeViews(kind, count, 7),
                                    {.levels = levels,
                                     .rules = mode == 1 ? kPublishedRules : kCorrectedRules,
                                     .flat = mode == 2});
                    if (HasFatalFailure()) return;
                }
}

TEST(ViewHierarchy, cornersOfTheCubeAreCellsOfTheirOwn) {
    std::vector<View> views;
    for (std::uint32_t i = 0; i < 8; ++i)
        views.push_back(makeView({i & 1, i >> 1 & 1, i >> 2 & 1}, {0, 1, 0}, i));
    const ViewHierarchy h = ViewHierarchy::build(views, {.levels = 11});
    // Eight single views below the root end at level 1.
    EXPECT_EQ(h.nodes.size(), 9u);
    EXPECT_EQ(h.leafCount, 8u);
    for (std::uint32_t i = 0; i < 8; ++i) EXPECT_EQ(h.sortedViews[i].slot, i);
    EXPECT_EQ(boxCenter(h.nodes[0]), glm::vec3(0.5f));
    const ViewHierarchy voxels =
        ViewHierarchy::build(views, {.levels = 11, .rules = kPublishedRules});
    EXPECT_EQ(voxels.nodes.size(), 81u);
}

TEST(ViewHierarchy, oneDirectionGivesAConeOfAlmostNoAngle) {
    std::vector<View> views = makeViews("volume", 500, 3);
    const glm::vec3 n = glm::normalize(glm::vec3(1, 2, 3));
    for (View& v : views) v = makeView(positionOf(v), n, v.slot);
    for (const ViewNode& node : ViewHierarchy::build(views, {}).nodes) {
        EXPECT_EQ(node.flags & kViewNodeNoCull, 0u);
        EXPECT_LT(-node.cosPsi, 5e-5f);
    }
}

TEST(ViewHierarchy, oppositeDirectionsAreNeverCulled) {
    const std::vector<View> views = {makeView({0.5f, 0.5f, 0.5f}, {0, 1, 0}, 0),
                                     makeView({0.5f, 0.5f, 0.5f}, {0, -1, 0}, 1)};
    const ViewHierarchy h = ViewHierarchy::build(views, {});
    EXPECT_EQ(h.leafCount, 1u);
    for (const ViewNode& node : h.nodes) EXPECT_TRUE(node.flags & kViewNodeNoCull);
}

// Cones merged in random trees hold every direction that went in, nearly parallel, spread and
// nearly opposite ones alike; sines and cosines stay a pair.
TEST(Cone, mergedConesHoldWhatWentIntoThem) {
    std::mt19937 random(11);
    std::normal_distribution<float> gauss(0, 1);
    std::uniform_real_distribution<float> unit(0, 1);
    std::size_t useful = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const float spread = std::pow(10.0f, -8 * unit(random) + 0.5f);
        const glm::vec3 mean =
            glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random)));
        struct C {
            glm::vec3 axis;
            float c, s;
            bool culls;
            std::vector<glm::vec3> inside;
        };
        const auto merge = [](const std::vector<C>& parts) {
            C m{{0, 0, 1}, 1, 0, true, {}};
            glm::vec3 sum(0);
            for (const C& p : parts) sum += p.axis;
            m.culls = coneAxis(sum, static_cast<float>(parts.size()), m.axis);
            for (const C& p : parts) {
                m.culls = m.culls && p.culls && coneInclude(m.axis, p.axis, p.c, p.s, m.c, m.s);
                m.inside.insert(m.inside.end(), p.inside.begin(), p.inside.end());
            }
            m.culls = m.culls && coneFinish(m.c, m.s);
            return m;
        };
        std::vector<C> row;
        for (int i = 0; i < 16; ++i) {
            const glm::vec3 n = glm::normalize(
                mean + spread * glm::vec3(gauss(random), gauss(random), gauss(random)));
            row.push_back({n, 1, 0, true, {n}});
        }
        while (row.size() > 1) {
            std::vector<C> up;
            for (std::size_t i = 0; i < row.size(); i += 2)
                up.push_back(merge({row[i], row[i + 1]}));
            row = up;
        }
        const C& top = row[0];
        if (!top.culls) continue;
        ++useful;
        ASSERT_NEAR(top.c * top.c + top.s * top.s, 1, 1e-6);
        const double theta = std::atan2(double{top.s}, double{top.c});
        ASSERT_LT(theta, 1.5707964);
        for (const glm::vec3& n : top.inside)
            ASSERT_LE(angle(n, top.axis), theta) << "trial " << trial << " spread " << spread;
    }
    EXPECT_GT(useful, 10000u);
}

TEST(Cone, intervalsHoldTheirEnds) {
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1);
    for (int i = 0; i < 200000; ++i) {
        const float a = unit(random);
        const float b = i % 3 ? a + std::pow(2.0f, -30 * unit(random)) : a;
        const float c = intervalCenter(a, b), h = intervalHalf(a, b, c);
        ASSERT_TRUE(std::abs(a - c) <= h && std::abs(b - c) <= h) << a << ' ' << b;
        ASSERT_TRUE(double{c} - double{h} <= a && double{c} + double{h} >= b) << a << ' ' << b;
        ASSERT_TRUE(a != b || h == 0) << a;
    }
}

TEST(Morton, keysAreInvertibleAndOrderedByCell) {
    std::mt19937 random(5);
    for (int i = 0; i < 100000; ++i) {
        const std::uint32_t x = random() & 1023, y = random() & 1023, z = random() & 1023;
        const std::uint32_t key = mortonEncode(x, y, z);
        ASSERT_LT(key, 1u << 30);
        ASSERT_EQ(mortonDecode(key), glm::uvec3(x, y, z));
        std::uint32_t slow = 0;
        for (std::uint32_t bit = 0; bit < 10; ++bit)
            slow |= (x >> bit & 1) << (3 * bit) | (y >> bit & 1) << (3 * bit + 1) |
                    (z >> bit & 1) << (3 * bit + 2);
        ASSERT_EQ(key, slow);
        const std::uint32_t other = random() & 0x3FFFFFFF;
        for (std::uint32_t leafLevel = 0; leafLevel <= 10; ++leafLevel) {
            std::uint32_t level = 1;
            while (level <= leafLevel && key >> (3 * (10 - level)) == other >> (3 * (10 - level)))
                ++level;
            ASSERT_EQ(firstDifferentLevel(key, other, leafLevel), level);
        }
    }
    for (const float x : {-1.0f, -0.0f, 0.0f, std::nanf("")}) EXPECT_EQ(mortonCell(x), 0u);
    for (const float x : {1.0f, 2.0f, 1e30f, INFINITY, std::nextafter(1.0f, 0.0f)})
        EXPECT_EQ(mortonCell(x), 1023u);
    EXPECT_EQ(mortonCell(0.5f), 512u);
    EXPECT_EQ(mortonCell(std::nextafter(0.5f, 0.0f)), 511u);
}

}  // namespace
}  // namespace mv
