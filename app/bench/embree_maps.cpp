// megaviews-embree-maps SCENE VIEWS.ply [TEXELS]: how long Embree takes for all the texels of the
// depth maps of a set of views, rtcIntersect8 on every core: what shared maps are up against. Views
// are those that `megaviews --save-views` wrote. Prints one JSON object: views, rays, seconds (the
// least of three rounds), millions of rays a second.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <vector>

#include "app/common/terminal.h"
#include "megaviews/core/error.h"
#include "megaviews/io/ply.h"
#include "megaviews/references/embree_scene.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/settings/settings_table.h"
#include "shaders/shared/parametrisation.glsl"

namespace mv {
namespace {

constexpr int kRounds = 3;

// Unit directions of all texels that a direction can fall into.
std::vector<glm::vec3> mapDirections(uint mapRes) {
    std::vector<glm::vec3> directions;
    for (uint texel = 0; texel < mapTexels(mapRes); ++texel) {
        if (texelReachable(texel, mapRes)) directions.push_back(texelDirection(texel, mapRes));
    }
    return directions;
}

double secondsOf(const EmbreeScene& embree, const ViewSet& views,
                 std::span<const glm::vec3> directions) {
    std::vector<float> nearest(views.views.size());
    const auto begin = std::chrono::steady_clock::now();
    using Range = tbb::blocked_range<std::size_t>;
    tbb::parallel_for(Range(0, views.views.size()), [&](const Range& range) {
        std::vector<float> depths(directions.size());
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
            const View& view = views.views[i];
            embree.closestDepths(viewPosition(view), directions, depths);
            nearest[i] = *std::min_element(depths.begin(), depths.end());
        }
    });
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

int run(int argc, char** argv) {
    if (argc != 3 && argc != 4) {
        throw Error(ExitCode::usage, "needs a scene and its views: SCENE VIEWS.ply [TEXELS]");
    }
    const int mapRes =
        argc == 4 ? static_cast<int>(numberFromText(argv[3], 8, 256, true, "TEXELS")) : 16;
    if ((mapRes & (mapRes - 1)) != 0) {
        throw Error(ExitCode::usage, "TEXELS is a power of two from 8 to 256");
    }
    const Scene scene = loadScene(argv[1]);
    const ViewSet views = loadViews(argv[2], scene.root);
    const TriangleBvh bvh = TriangleBvh::build(scene);
    const EmbreeScene embree(bvh);
    const std::vector<glm::vec3> directions = mapDirections(static_cast<uint>(mapRes));
    double seconds = std::numeric_limits<double>::infinity();
    for (int round = 0; round < kRounds; ++round) {
        seconds = std::min(seconds, secondsOf(embree, views, directions));
    }
    const double rays = static_cast<double>(views.views.size() * directions.size());
    std::printf("{\"views\": %zu, \"rays\": %.0f, \"seconds\": %.4f, \"Mrays/s\": %.2f}\n",
                views.views.size(), rays, seconds, rays / seconds * 1e-6);
    return static_cast<int>(ExitCode::ok);
}

}  // namespace
}  // namespace mv

int main(int argc, char** argv) {
    return mv::runProgram("megaviews-embree-maps", mv::run, argc, argv);
}
