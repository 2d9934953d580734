#include "app/bench/benchmark.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/common/run_statistics.h"
#include "app/common/terminal.h"
#include "megaviews/settings/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/frame_renderer.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

// Renders one repetition of one row; a request that cannot fit is noted and not tried again.
void renderRow(FrameRenderer& renderer, const SceneAssets& assets, Settings settings,
               BenchmarkRow& row, bool measured) {
    if (!row.refusal.empty()) return;
    settings.method = row.method;
    settings.compare.reset();
    (settings.particles > 0 ? settings.particles : settings.vpls) = row.views;
    FrameInput input;
    input.camera = chosenCamera(settings, assets, settings.timeS);
    input.timeS = settings.timeS;
    input.animation = assets.animation;
    input.reuse = false;
    try {
        renderer.render(settings, input, row.statistics);
    } catch (const Error& error) {
        if (error.code != ExitCode::impossible) throw;
        row.refusal = error.what();
        spdlog::warn("{}, {} views: {}", nameOf(row.method), row.views, row.refusal);
        return;
    }
    if (!measured) return;
    row.shared.add(row.statistics.sharedStages);
    row.stages.add(row.statistics.methods.front().stages);
    row.visibilityMs.push_back(visibilityMs(row.statistics.methods.front().stages));
    row.frameMs.push_back(row.statistics.frameMs);
}

void fillRatios(std::vector<BenchmarkRow>& rows, std::size_t begin) {
    const auto lods =
        std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(begin), rows.end(),
                     [](const BenchmarkRow& row) { return row.method == Method::manylods; });
    if (lods == rows.end() || !lods->refusal.empty()) return;
    for (std::size_t r = begin; r < rows.size(); ++r) {
        BenchmarkRow& row = rows[r];
        std::vector<double> ratios;
        for (std::size_t i = 0; i < row.visibilityMs.size(); ++i) {
            if (row.visibilityMs[i] > 0) {
                ratios.push_back(lods->visibilityMs[i] / row.visibilityMs[i]);
            }
        }
        row.ratioToManyLods = summarize(std::move(ratios));
    }
}

std::string countText(std::int64_t n) {
    if (n >= 1048576 && n % 1048576 == 0) return std::to_string(n / 1048576) + "M";
    if (n >= 1024 && n % 1024 == 0) return std::to_string(n / 1024) + "K";
    return std::to_string(n);
}

}  // namespace

std::vector<BenchmarkRow> runBenchmark(const SceneAssets& assets, const Settings& settings,
                                       const BenchmarkRequest& request) {
    FrameRenderer renderer;
    renderer.setScene(assets.scene, assets.bvh, assets.hierarchy);
    std::vector<BenchmarkRow> rows;
    for (const std::int64_t views : request.viewCounts) {
        const std::size_t begin = rows.size();
        for (const Method method : request.methods) {
            BenchmarkRow row;
            row.method = method;
            row.views = views;
            rows.push_back(std::move(row));
        }
        for (int i = -request.warmup; i < request.frames; ++i) {
            for (std::size_t r = begin; r < rows.size(); ++r) {
                if (interrupted()) throw Cancelled();
                renderRow(renderer, assets, settings, rows[r], i >= 0);
            }
        }
        fillRatios(rows, begin);
        for (std::size_t r = begin; r < rows.size(); ++r) {
            spdlog::info("{} views, {}: {:.2f} ms", countText(views), nameOf(rows[r].method),
                         summarize(rows[r].visibilityMs).median);
        }
    }
    return rows;
}

std::string benchmarkTable(const std::vector<BenchmarkRow>& rows) {
    std::string out = fmt::format("{:>8} {:<10} {:>12} {:>12} {:>10} {:>8} {:>10} {:>10} {:>7}\n",
                                  "views", "method", "visibility", "p95", "frame", "speedup",
                                  "pairs", "views/pair", "passes");
    out += fmt::format("{:>8} {:<10} {:>12} {:>12} {:>10} {:>8} {:>10} {:>10} {:>7}\n", "", "",
                       "median ms", "ms", "median ms", "x", "millions", "", "");
    for (const BenchmarkRow& row : rows) {
        out += fmt::format("{:>8} {:<10} ", countText(row.views), nameOf(row.method));
        if (!row.refusal.empty()) {
            out += row.refusal + "\n";
            continue;
        }
        const Summary visibility = summarize(row.visibilityMs);
        const MethodStatistics& method = row.statistics.methods.front();
        const std::string ratio =
            row.ratioToManyLods.count ? fmt::format("{:.2f}", row.ratioToManyLods.median) : "-";
        const bool counted = method.pairs.processed > 0;
        const auto orDash = [&](double value) {
            return counted ? fmt::format("{:.2f}", value) : std::string("-");
        };
        out += fmt::format("{:>12.2f} {:>12.2f} {:>10.2f} {:>8} {:>10} {:>10} {:>7}\n",
                           visibility.median, visibility.p95, summarize(row.frameMs).median, ratio,
                           orDash(static_cast<double>(method.pairs.processed) * 1e-6),
                           orDash(method.pairs.viewsPerRenderedNode()), method.passes);
    }
    if (!rows.empty()) {
        out +=
            "visibility: the stages that make maps; speedup: ManyLoDs' visibility time over "
            "this method's.\nclock: " +
            rows.front().statistics.clock + "\n";
    }
    return out;
}

std::string benchmarkCsv(const std::vector<BenchmarkRow>& rows) {
    std::string out =
        "method,views,alive,visibility_ms_median,visibility_ms_p95,frame_ms_median,"
        "speedup_median,processed,culled,rendered,subdivided,skipped,forced,"
        "views_per_rendered_node,queue_peak_pairs,passes,queue_bytes,map_bytes,"
        "clock,refusal\n";
    for (const BenchmarkRow& row : rows) {
        if (!row.refusal.empty()) {
            out += fmt::format("{},{},,,,,,,,,,,,,,,,,,\"{}\"\n", nameOf(row.method), row.views,
                               row.refusal);
            continue;
        }
        const Summary visibility = summarize(row.visibilityMs);
        const MethodStatistics& m = row.statistics.methods.front();
        out += fmt::format(
            "{},{},{},{:.4f},{:.4f},{:.4f},{},{},{},{},{},{},{},{:.4f},{},{},{},{},\"{}\",\n",
            nameOf(row.method), row.views, row.statistics.viewsAlive, visibility.median,
            visibility.p95, summarize(row.frameMs).median,
            row.ratioToManyLods.count ? fmt::format("{:.4f}", row.ratioToManyLods.median) : "",
            m.pairs.processed, m.pairs.culled, m.pairs.rendered, m.pairs.subdivided,
            m.pairs.skipped, m.pairs.forced, m.pairs.viewsPerRenderedNode(), m.queuePeakPairs,
            m.passes, m.queueBytes, m.mapBytes, row.statistics.clock);
    }
    return out;
}

Json benchmarkJson(const std::vector<BenchmarkRow>& rows, const SceneAssets& assets,
                   const Settings& settings, const BenchmarkRequest& request) {
    Json out = {{"schema", kStatisticsSchema}, {"program", programJson()},
                {"gl", graphicsJson()},        {"host", hostJson()},
                {"scene", sceneJson(assets)},  {"settings", toJson(settings)}};
    out["frames"] = {{"warmup", request.warmup}, {"measured", request.frames}};
    out["rows"] = Json::array();
    for (const BenchmarkRow& row : rows) {
        Json entry = {{"method", nameOf(row.method)}, {"views", row.views}};
        if (!row.refusal.empty()) {
            entry["refusal"] = row.refusal;
        } else {
            const Json numbers = toJson(row.statistics.methods.front());
            for (const auto& [key, value] : numbers.items()) entry[key] = value;
            entry["alive"] = row.statistics.viewsAlive;
            entry["visibilityMs"] = toJson(summarize(row.visibilityMs));
            entry["frameMs"] = toJson(summarize(row.frameMs));
            entry["speedup"] =
                row.ratioToManyLods.count ? toJson(row.ratioToManyLods) : Json(nullptr);
            entry["ms"] = row.stages.toJson();
            entry["sharedMs"] = row.shared.toJson();
            entry["clock"] = row.statistics.clock;
        }
        out["rows"].push_back(std::move(entry));
    }
    return out;
}

}  // namespace mv
