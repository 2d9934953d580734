#include "megaviews/scene/rigged_scene.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <set>
#include <span>

#include "megaviews/core/hash.h"
#include "megaviews/scene/pose.h"
#include "megaviews/scene/posed_draw.h"

namespace mv {

namespace {

// Times at which the way of what moves is found: as many as can be posed in about a second.
constexpr std::size_t kFewestTimes = 16, kMostTimes = 128, kVerticesPosed = std::size_t{8} << 20;

WorldBox boxOf(std::span<const Draw> draws) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, draws.size()), WorldBox{},
        [&](const tbb::blocked_range<std::size_t>& range, WorldBox sum) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) sum.add(worldBox(draws[i]));
            return sum;
        },
        [](WorldBox a, const WorldBox& b) { return a.add(b), a; });
}

// Of the grid that a draw's positions lie on, root-cube units. Its matrix may stretch it otherwise
// each way; as the whole is stretched is near enough.
float stepOf(const Draw& draw, const RootCube& root) {
    if (!(draw.primitive->positionStep > 0)) return 0;
    WorldBox own;
    for (const glm::dvec3& p : draw.primitive->positions) own.add(p);
    const WorldBox placed = worldBox(draw);
    const double stretch = glm::length(placed.max - placed.min) / glm::length(own.max - own.min);
    const double step = draw.primitive->positionStep * stretch / root.edge;
    return step > 0 ? static_cast<float>(std::min(step, 1.0)) : 0.0f;  // 0 for NaN
}

// Whether a cube leaves a box half of the margin that one around it would, and is not much larger:
// one pose of what moved is saved in the cube of all its way.
bool fits(const RootCube& cube, const WorldBox& box, const RootCube& around) {
    constexpr float kMargin = 1.0f / 128;
    const glm::vec3 low = cube.rootFromWorld(box.min), high = cube.rootFromWorld(box.max);
    for (int k = 0; k < 3; ++k) {
        if (!(low[k] >= kMargin && high[k] <= 1 - kMargin)) return false;  // also NaN, an empty box
    }
    return cube.edge <= 64 * around.edge;
}

// What a pose decides of a piece. first: its vertex and triangle in the scene.
void placePiece(const ScenePiece& piece, glm::uvec2 first, Scene& scene) {
    std::copy(piece.positions.begin(), piece.positions.end(), scene.positions.begin() + first.x);
    std::copy(piece.normals.begin(), piece.normals.end(), scene.normals.begin() + first.x);
    for (std::size_t t = 0; t < piece.triangles.size(); ++t) {
        scene.triangles[first.y + t] = piece.triangles[t] + first.x;
    }
}

// Appends the pieces in order; an optional array exists if any piece has it. Returns each piece's
// first vertex and first triangle, and the end.
std::vector<glm::uvec2> join(std::span<const ScenePiece> pieces, std::span<const Draw> draws,
                             Scene& scene) {
    std::vector<glm::uvec2> first{glm::uvec2(0)};
    bool colors = false, uvs = false, emissiveUvs = false;
    for (const ScenePiece& piece : pieces) {
        first.push_back(first.back() + glm::uvec2(piece.positions.size(), piece.triangles.size()));
        colors = colors || !piece.colors.empty();
        uvs = uvs || !piece.uvs.empty();
        emissiveUvs = emissiveUvs || !piece.emissiveUvs.empty();
    }
    const std::size_t vertices = first.back().x, triangles = first.back().y;
    scene.positions.resize(vertices);
    scene.normals.resize(vertices);
    if (colors) scene.colors.assign(vertices, glm::vec4(1));
    if (uvs) scene.uvs.assign(vertices, glm::vec2(0));
    if (emissiveUvs) scene.emissiveUvs.assign(vertices, glm::vec2(0));
    scene.triangles.resize(triangles);
    scene.triangleMaterials.resize(triangles);
    tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
        const ScenePiece& piece = pieces[i];
        const auto at = static_cast<std::ptrdiff_t>(first[i].x);
        placePiece(piece, first[i], scene);
        std::copy(piece.colors.begin(), piece.colors.end(),
                  scene.colors.begin() + (colors ? at : 0));
        std::copy(piece.uvs.begin(), piece.uvs.end(), scene.uvs.begin() + (uvs ? at : 0));
        std::copy(piece.emissiveUvs.begin(), piece.emissiveUvs.end(),
                  scene.emissiveUvs.begin() + (emissiveUvs ? at : 0));
        std::fill_n(scene.triangleMaterials.begin() + first[i].y, piece.triangles.size(),
                    draws[i].primitive->material);
    });
    return first;
}

std::string hashAt(const std::string& content, PoseTime time) {
    return Hash()
        .add(content + "/" + std::to_string(time.animation) + "/")
        .add(std::span(&time.timeS, 1))
        .hex();
}

// The draws that move, with the primitives that they draw.
RiggedScene onlyMoving(RiggedScene rigged, std::size_t firstMoving) {
    RiggedScene kept;
    kept.rig = std::move(rigged.rig);
    kept.skins = std::move(rigged.skins);
    std::vector<std::size_t> place(rigged.primitives.size(), SIZE_MAX);
    for (std::size_t i = firstMoving; i < rigged.draws.size(); ++i) {
        RiggedDraw draw = std::move(rigged.draws[i]);
        std::size_t& at = place[draw.primitive];
        if (at == SIZE_MAX) {
            at = kept.primitives.size();
            kept.primitives.push_back(std::move(rigged.primitives[draw.primitive]));
        }
        draw.primitive = at;
        kept.draws.push_back(std::move(draw));
    }
    return kept;
}

std::vector<Draw> drawsAt(const RiggedScene& rigged, PoseTime time) {
    return drawsAt(rigged.rig, rigged.primitives, rigged.skins, rigged.draws, time);
}

// Where what moves goes in all of the animation, and when each draw is at its reference.
struct Way {
    WorldBox box;
    std::vector<double> referenceS;
};
Way wayOf(const RiggedScene& rigged, std::size_t firstMoving, int animation, double durationS) {
    std::size_t vertices = 1;
    for (std::size_t i = firstMoving; i < rigged.draws.size(); ++i) {
        vertices += rigged.primitives[rigged.draws[i].primitive].positions.size();
    }
    const std::size_t times = std::clamp(kVerticesPosed / vertices, kFewestTimes, kMostTimes);
    std::vector<WorldBox> boxes(times);
    std::vector<std::vector<double>> areas(times);  // of each draw
    const auto timeOf = [&](std::size_t k) {
        return durationS * static_cast<double>(k) / static_cast<double>(times);
    };
    const std::span moving = std::span(rigged.draws).subspan(firstMoving);
    tbb::parallel_for(std::size_t{0}, times, [&](std::size_t k) {
        for (const Draw& draw :
             drawsAt(rigged.rig, rigged.primitives, rigged.skins, moving, {animation, timeOf(k)})) {
            boxes[k].add(worldBox(draw));
            areas[k].push_back(worldArea(draw));
        }
    });
    Way way;
    for (const WorldBox& box : boxes) way.box.add(box);
    const auto largest = [&](const auto& areaAt) {
        std::size_t reference = 0;
        for (std::size_t k = 1; k < times; ++k) {  // not for rounding: of times alike the first
            if (areaAt(k) > 1.001 * areaAt(reference)) reference = k;
        }
        return reference;
    };
    const std::size_t common = largest(
        [&](std::size_t k) { return std::accumulate(areas[k].begin(), areas[k].end(), 0.0); });
    constexpr double kSmall = 0.25;  // of the largest surface of a draw
    for (std::size_t i = 0; i < moving.size(); ++i) {
        const std::size_t own = largest([&](std::size_t k) { return areas[k][i]; });
        const bool isSmall = areas[common][i] < kSmall * areas[own][i];
        way.referenceS.push_back(timeOf(isSmall ? own : common));
    }
    return way;
}

}  // namespace

LeftOut assembleGeometry(RiggedScene rigged, PoseTime time, double durationS,
                         const std::optional<RootCube>& stated, Scene& scene,
                         const Progress& progress) {
    // What moves comes last.
    const std::vector<bool> moves =
        movingDraws(rigged.rig, rigged.primitives, rigged.skins, rigged.draws, time.animation);
    const auto moving = static_cast<std::size_t>(std::count(moves.begin(), moves.end(), true));
    const std::size_t standing = moves.size() - moving;
    if (moving > 0) {
        std::vector<RiggedDraw> sorted;
        for (const bool which : {false, true}) {
            for (std::size_t i = 0; i < moves.size(); ++i) {
                if (moves[i] == which) sorted.push_back(std::move(rigged.draws[i]));
            }
        }
        rigged.draws = std::move(sorted);
    }
    std::vector<Draw> draws = drawsAt(rigged, time);

    report(progress, "place geometry", 0);
    WorldBox box = boxOf(std::span(draws).first(standing));
    Way way;
    if (moving > 0) way = wayOf(rigged, standing, time.animation, durationS);
    box.add(way.box);
    scene.root = RootCube::around(box.min, box.max);
    if (stated && fits(*stated, box, scene.root)) scene.root = *stated;

    std::vector<ScenePiece> pieces(draws.size());
    std::vector<float> steps(draws.size());
    std::atomic<std::size_t> done{0};
    tbb::parallel_for(std::size_t{0}, draws.size(), [&](std::size_t i) {
        pieces[i] = makePiece(draws[i], scene.root, i >= standing);
        steps[i] = stepOf(draws[i], scene.root);
        const std::size_t count = ++done;
        if (count % (draws.size() / 10 + 1) == 0) {
            report(progress, "place geometry",
                   static_cast<float>(count) / static_cast<float>(draws.size()));
        }
    });
    const std::vector<glm::uvec2> first = join(pieces, draws, scene);
    for (const float step : steps) scene.positionStep = std::max(scene.positionStep, step);
    LeftOut leftOut;
    for (const ScenePiece& piece : pieces) {
        leftOut.notFinite += piece.notFinite;
        leftOut.flat += piece.flat;
        leftOut.badNormals += piece.badNormals;
    }
    if (moving == 0 || first[standing] == first.back()) return leftOut;

    auto kept = std::make_shared<MovingGeometry>();
    kept->rigged = onlyMoving(std::move(rigged), standing);
    kept->animation = time.animation;
    kept->durationS = durationS;
    kept->referenceS = way.referenceS;
    kept->first.assign(first.begin() + static_cast<std::ptrdiff_t>(standing), first.end() - 1);
    kept->vertex = first[standing].x;
    kept->triangle = first[standing].y;
    kept->min = glm::clamp(scene.root.rootFromWorld(way.box.min), 0.0f, 1.0f);
    kept->max = glm::clamp(scene.root.rootFromWorld(way.box.max), 0.0f, 1.0f);
    kept->contentHash = scene.contentHash;
    scene.moving = std::move(kept);
    scene.poseS = time.timeS;
    scene.contentHash = hashAt(scene.contentHash, time);
    return leftOut;
}

namespace {

void place(std::span<const Draw> draws, double time, Scene& scene) {
    const MovingGeometry& moving = *scene.moving;
    tbb::parallel_for(std::size_t{0}, draws.size(), [&](std::size_t i) {
        placePiece(makePiece(draws[i], scene.root, true), moving.first[i], scene);
    });
    scene.poseS = time;
    ++scene.poseNumber;
    scene.contentHash = hashAt(moving.contentHash, {moving.animation, time});
}

}  // namespace

bool poseScene(Scene& scene, double timeS) {
    if (!scene.moving) return false;
    const MovingGeometry& moving = *scene.moving;
    const double time = loopTime(timeS, moving.durationS);
    if (time == scene.poseS) return false;
    place(drawsAt(moving.rigged, {moving.animation, time}), time, scene);
    return true;
}

void poseForTrees(Scene& scene) {
    if (!scene.moving) return;
    const MovingGeometry& moving = *scene.moving;
    std::vector<Draw> draws(moving.referenceS.size());
    for (const double time : std::set(moving.referenceS.begin(), moving.referenceS.end())) {
        const std::vector<Draw> then = drawsAt(moving.rigged, {moving.animation, time});
        for (std::size_t i = 0; i < draws.size(); ++i) {
            if (moving.referenceS[i] == time) draws[i] = then[i];
        }
    }
    place(draws, std::numeric_limits<double>::quiet_NaN(), scene);  // no time of all
}

}  // namespace mv
