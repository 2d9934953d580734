#include "app/common/run_statistics.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "app/common/program_version.h"
#include "megaviews/core/output_file.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"
#include "renderer/gl/workarounds.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

std::string cpuName() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (!line.starts_with("model name")) continue;
        const std::size_t colon = line.find(": ");
        if (colon != std::string::npos) return line.substr(colon + 2);
    }
    return "unknown";
}

}  // namespace

Json programJson() {
    return {{"name", "megaviews"},
            {"version", programVersion()},
            {"commit", programCommit()},
            {"build", programBuildType()}};
}

Json graphicsJson() {
    const gl::Limits& limits = gl::limits();
    return {{"vendor", limits.vendor},
            {"renderer", limits.renderer},
            {"version", limits.version},
            {"platform", limits.platform},
            {"software", limits.software},
            {"workarounds", gl::workaroundsOn()},
            {"workGroupSize", limits.workGroupSize},
            {"maxStorageBlockBytes", limits.maxStorageBlockBytes}};
}

Json hostJson() { return {{"cpu", cpuName()}, {"threads", std::thread::hardware_concurrency()}}; }

Json sceneJson(const SceneAssets& assets) {
    const Scene& scene = assets.scene;
    const SceneHierarchy& hierarchy = assets.hierarchy;
    Json nodes = Json::array(), leaves = Json::array();
    for (std::size_t level = 0; level + 1 < hierarchy.levelBegin.size(); ++level) {
        std::uint64_t leafCount = 0;
        for (std::uint32_t n = hierarchy.levelBegin[level]; n < hierarchy.levelBegin[level + 1];
             ++n) {
            leafCount += childCountOf(hierarchy.nodes[n].children) == 0;
        }
        nodes.push_back(hierarchy.levelBegin[level + 1] - hierarchy.levelBegin[level]);
        leaves.push_back(leafCount);
    }
    return {{"name", scene.name},
            {"hash", scene.hash},
            {"triangles", scene.triangles.size()},
            {"worldEdge", scene.root.edge},
            {"levels", hierarchy.levels},
            {"nodesPerLevel", nodes},
            {"leavesPerLevel", leaves}};
}

std::string textOf(const Json& json) {
    // Names come from files and command lines: a byte that is no UTF-8 must not lose the report.
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

void writeJson(const std::string& file, const Json& json) {
    OutputFile output(file);
    output.write(textOf(json) + "\n");
    output.commit();
}

void RunStatistics::add(const FrameStatistics& frame) {
    ++frames_;
    badPixels_ += frame.badPixels;
    frameMs_.push_back(frame.frameMs);
    bothSides_.add(frame.stagesOfBothSides);
    methods_.resize(std::max(methods_.size(), frame.methods.size()));
    for (std::size_t i = 0; i < frame.methods.size(); ++i) {
        methods_[i].add(frame.methods[i].stages);
    }
    last_ = frame;
}

Json RunStatistics::toJson(const SceneAssets& assets, const Settings& settings,
                           const Run& run) const {
    Json out = {{"schema", kStatisticsSchema}, {"program", programJson()},
                {"gl", graphicsJson()},        {"host", hostJson()},
                {"scene", sceneJson(assets)},  {"settings", mv::toJson(settings)}};
    out["frames"] = {{"warmup", run.warmupFrames}, {"measured", frames_}, {"partial", run.partial}};
    out["deterministic"] = run.deterministic;
    out["clock"] = last_.clock;

    Json frame = mv::toJson(last_);
    frame.erase("frameMs");
    for (auto& [key, value] : frame.items()) out[key] = value;
    out["picture"]["badPixels"] = badPixels_;
    out["frameMs"] = mv::toJson(summarize(frameMs_));
    out["shared"] = {{"ms", bothSides_.toJson()}, {"clock", last_.clock}};

    out["methods"] = Json::array();
    for (std::size_t i = 0; i < methods_.size(); ++i) {
        const MethodSettings& side = settings.side.at(i);
        Json entry = {{"method", nameOf(side.method)},
                      {"traversal", nameOf(side.pairs.traversal)},
                      {"rules", nameOfRules(side.rules)},
                      {"viewRes", side.maps.resolution}};
        const Json numbers = mv::toJson(last_.methods[i]);
        for (const auto& [key, value] : numbers.items()) entry[key] = value;
        entry["ms"] = methods_[i].toJson();
        entry["clock"] = last_.clock;
        out["methods"].push_back(std::move(entry));
    }
    return out;
}

}  // namespace mv
