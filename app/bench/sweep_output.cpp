#include "app/bench/sweep_output.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <filesystem>

#include "app/common/run_statistics.h"
#include "megaviews/core/error.h"
#include "megaviews/core/hash.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/output_file.h"
#include "megaviews/core/strict_json.h"
#include "megaviews/core/text.h"
#include "megaviews/measure/map_errors.h"
#include "megaviews/settings/settings_table.h"
#include "megaviews/settings/statistics_table.h"

namespace mv {
namespace {

using Json = nlohmann::ordered_json;

const char* kKind = "megaviews sweep";

Json searchJson(const SweepSearch& search) {
    const bool time = search.goal == SweepSearch::Goal::time;
    Json out = {{"goal", time ? "time" : "error"}, {"limit", search.limit}};
    if (!time) {
        out["metric"] = infoOf(search.metric).name;
        out["against"] = nameOf(search.against);
    }
    out["vary"] = {{"key", search.vary.key}, {"values", search.vary.values}};
    return out;
}

// The member at "ms.maps.median"; null if there is none. A name may hold dots of its own: parts are
// taken as long as they match.
const Json& member(const Json& object, const std::string& path) {
    static const Json kNothing;
    if (!object.is_object()) return kNothing;
    if (const auto it = object.find(path); it != object.end()) return *it;
    for (std::size_t dot = path.find('.'); dot != std::string::npos;
         dot = path.find('.', dot + 1)) {
        const auto it = object.find(path.substr(0, dot));
        if (it != object.end()) return member(*it, path.substr(dot + 1));
    }
    return kNothing;
}

std::string plain(const Json& value) {
    if (value.is_null()) return "n/a";
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "on" : "off";
    if (value.is_number_float()) return fmt::format("{:.7g}", value.get<double>());
    if (!value.is_array()) return value.dump();
    std::string out;  // a size or a place
    for (const Json& part : value) {
        out += (out.empty() ? "" : value.size() == 2 ? "x" : ",") + plain(part);
    }
    return out;
}

std::string csvField(const std::string& text) {
    return text.find_first_of(",\"\r\n") == std::string::npos ? text : csvQuoted(text);
}

// Columns as paths into a point; those of the swept keys, which open the line, go by their names.
std::vector<std::string> pointColumns(const SweepEntries& points) {
    std::vector<std::string> columns = {"refusal"};
    const auto summary = [&](const std::string& path) {
        for (const char* part : {"median", "min", "max", "sd"})
            columns.push_back(path + "." + part);
    };
    for (const char* part : {"views.requested", "views.alive", "views.nodes", "views.leaves"}) {
        columns.emplace_back(part);
    }
    for (const char* part : {"ms.maps", "ms.gather", "ms.indirect", "ms.frame"}) summary(part);
    columns.emplace_back("speedup.median");
    for (const auto& info : methodStatistics()) {
        std::string path(info.path.substr(1));
        std::replace(path.begin(), path.end(), '/', '.');
        columns.push_back(std::move(path));
    }
    for (const StageInfo& stage : stageTable()) summary("stages." + std::string(stage.name));
    std::vector<std::string> memory;
    for (const Json& point : points) {
        for (const auto& [name, bytes] : member(point, "memory").items()) {
            const std::string path = "memory." + name;
            if (std::find(memory.begin(), memory.end(), path) == memory.end()) {
                memory.push_back(path);
            }
        }
    }
    columns.insert(columns.end(), memory.begin(), memory.end());
    for (const char* against : {"exact", "pathtraced"}) {
        for (const MetricInfo& info : metricsTable()) {
            columns.push_back(std::string("errors.") + against + "." + std::string(info.name));
        }
    }
    columns.emplace_back("errors.maps.views");
    for (const MapMetricInfo& info : mapMetricsTable()) {
        columns.push_back("errors.maps." + std::string(info.name));
    }
    columns.emplace_back("badPixels");
    columns.emplace_back("clock");
    for (const SettingInfo& setting : settingsTable()) {
        columns.push_back("settings." + std::string(setting.key));
    }
    return columns;
}

const std::vector<std::string> kHeadColumns = {
    "schema",   "program.version", "program.commit", "gl.renderer",   "gl.version",
    "host.cpu", "scene.name",      "scene.hash",     "frames.warmup", "frames.measured"};

std::string number(const Json& value, int decimals, double scale) {
    if (!value.is_number()) return "n/a";
    return fmt::format("{:.{}f}", value.get<double>() * scale, decimals);
}

// 65536 as 64K, like the papers.
std::string countText(const Json& value) {
    if (!value.is_number_integer()) return plain(value);
    const auto n = value.get<std::int64_t>();
    if (n >= 1048576 && n % 1048576 == 0) return std::to_string(n / 1048576) + "M";
    if (n >= 1024 && n % 1024 == 0) return std::to_string(n / 1024) + "K";
    return std::to_string(n);
}

bool hasErrors(const SweepEntries& points, const char* against) {
    return std::any_of(points.begin(), points.end(), [&](const Json& point) {
        return member(point, std::string("errors.") + against).is_object();
    });
}

// What the table says of a point beside its keys and errors.
struct TableColumn {
    const char *name, *unit, *path;
    int decimals = 2;
    double scale = 1;
};
constexpr TableColumn kTableColumns[] = {
    {"maps", "median ms", "ms.maps.median"},     {"maps", "p95 ms", "ms.maps.p95"},
    {"gather", "median ms", "ms.gather.median"}, {"frame", "median ms", "ms.frame.median"},
    {"speedup", "x", "speedup.median"},          {"pairs", "millions", "pairs.processed", 2, 1e-6},
    {"views/pair", "", "viewsPerRenderedNode"},  {"passes", "", "passes", 0}};

// Rows below each other, the keys left in their columns and numbers right. A refusal, which stands
// behind the keys instead of numbers, widens no column.
std::string aligned(const std::vector<std::vector<std::string>>& rows, std::size_t keys) {
    std::vector<std::size_t> widths(rows[0].size());
    for (const auto& row : rows) {
        if (row.size() == keys + 1) continue;
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    }
    std::string out;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const bool left = c < keys || row.size() == keys + 1;
            line += fmt::format(fmt::runtime(left ? "{:<{}}  " : "{:>{}}  "), row[c], widths[c]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + "\n";
    }
    return out;
}

// Whether a point has no error against a reference that was made since.
bool lacksWhatIsThere(const Json& entry, const std::filesystem::path& references) {
    if (references.empty() || !entry.contains("missingReferences")) return false;
    std::error_code unreadable;
    const Json& names = entry.at("missingReferences");
    return std::any_of(names.begin(), names.end(), [&](const Json& name) {
        return name.is_string() &&
               std::filesystem::exists(references / name.get<std::string>(), unreadable);
    });
}

}  // namespace

Json sweepHead(const SweepRequest& request, const SceneAssets& assets, const std::string& command) {
    Json axes = Json::array();
    for (const SweepAxis& axis : request.axes) {
        axes.push_back({{"key", axis.key}, {"values", axis.values}});
    }
    Json scene = sceneJson(assets);
    scene["asked"] = request.scene;
    std::string viewsHash;
    if (const std::string& file = request.base.views.file; !file.empty()) {
        const Resource views = readRegularFile(file);
        if (!views.ok()) throw Error(ExitCode::input, file + ": " + views.error);
        viewsHash = Hash().add(std::as_bytes(std::span(views.bytes))).hex();
    }
    return {{"schema", kSweepSchema},
            {"kind", kKind},
            {"command", command},
            {"program", programJson()},
            {"gl", graphicsJson()},
            {"host", hostJson()},
            {"scene", std::move(scene)},
            {"viewsHash", viewsHash},
            {"references", !request.referencesFolder.empty()},
            {"seed", request.base.seed},
            {"frames", {{"warmup", request.warmup}, {"measured", request.frames}}},
            {"axes", std::move(axes)},
            {"search", request.search ? searchJson(*request.search) : Json(nullptr)},
            {"settings", toJson(request.base)}};
}

Json sweepJson(Json head, const SweepEntries& points) {
    Json measured = Json::array();
    std::string clock;
    for (const Json& point : points) {
        if (point.is_null()) continue;
        measured.push_back(point);
        if (clock.empty() && member(point, "clock").is_string()) clock = point.at("clock");
    }
    head["clock"] = clock.empty() ? Json(nullptr) : Json(clock);
    head["partial"] = measured.size() < points.size();
    head["points"] = std::move(measured);
    return head;
}

std::string sweepCsv(const Json& head, const SweepEntries& points) {
    const std::vector<std::string> columns = pointColumns(points);
    const bool search = head.at("search").is_object();
    std::vector<std::string> names;
    for (const Json& axis : head.at("axes")) names.push_back(axis.at("key"));
    if (search) names.insert(names.end(), {"search.met", "search.value"});
    names.insert(names.end(), columns.begin(), columns.end());
    names.insert(names.end(), kHeadColumns.begin(), kHeadColumns.end());
    std::string out;
    const auto line = [&](const std::vector<std::string>& fields) {
        for (std::size_t i = 0; i < fields.size(); ++i) {
            out += (i ? "," : "") + csvField(fields[i]);
        }
        out += '\n';
    };
    line(names);
    for (const Json& point : points) {
        if (point.is_null()) continue;
        std::vector<std::string> fields;
        for (const Json& axis : head.at("axes")) {
            fields.push_back(plain(point.at("values").at(axis.at("key").get<std::string>())));
        }
        if (search) {
            fields.push_back(plain(member(point, "search.met")));
            fields.push_back(plain(member(point, "search.value")));
        }
        for (const std::string& column : columns) fields.push_back(plain(member(point, column)));
        for (const std::string& column : kHeadColumns)
            fields.push_back(plain(member(head, column)));
        line(fields);
    }
    return out;
}

std::string sweepTable(const Json& head, const SweepEntries& points) {
    std::vector<std::vector<std::string>> rows(2);
    const auto column = [&](const std::string& name, const std::string& unit) {
        rows[0].push_back(name);
        rows[1].push_back(unit);
    };
    const bool search = head.at("search").is_object();
    for (const Json& axis : head.at("axes")) column(axis.at("key"), "");
    if (search) column(head.at("search").at("vary").at("key"), "found");
    const std::size_t keys = rows[0].size();
    for (const TableColumn& c : kTableColumns) column(c.name, c.unit);
    std::vector<std::pair<const char*, const char*>> errors;
    for (const char* against : {"exact", "pathtraced"}) {
        if (!hasErrors(points, against)) continue;
        for (const char* metric : {"relmse", "psnr"}) {
            column(metric, against);
            errors.emplace_back(against, metric);
        }
    }
    std::string clock;
    for (const Json& p : points) {
        if (p.is_null()) continue;
        std::vector<std::string> row;
        for (const auto& [key, value] : p.at("values").items()) row.push_back(countText(value));
        if (search) {
            const bool met = member(p, "search.met") == Json(true);
            row.push_back((met ? "" : "not met: ") + countText(member(p, "search.value")));
        }
        if (member(p, "refusal").is_string()) {
            row.push_back(p.at("refusal"));
            rows.push_back(std::move(row));
            continue;
        }
        if (clock.empty()) clock = plain(member(p, "clock"));
        for (const TableColumn& c : kTableColumns) {
            row.push_back(number(member(p, c.path), c.decimals, c.scale));
        }
        for (const auto& [against, metric] : errors) {
            const Json& value = member(p, std::string("errors.") + against + "." + metric);
            row.push_back(value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : "n/a");
        }
        rows.push_back(std::move(row));
    }
    const std::string out = aligned(rows, keys);
    if (clock.empty()) return out;
    return out +
           "maps: the stages that make maps; speedup: ManyLoDs' time of the maps over this "
           "method's.\nclock: " +
           clock + "\n";
}

void writeSweep(const std::string& name, const Json& head, const SweepEntries& points) {
    OutputFile csv(name + ".csv");
    csv.write(sweepCsv(head, points));
    csv.commit();
    writeJson(name + ".json", sweepJson(head, points));
}

ResumedPoints resumedPoints(const std::string& name, const Json& head,
                            const std::vector<SweepPoint>& points,
                            const std::vector<SweepAxis>& axes,
                            const std::filesystem::path& references) {
    ResumedPoints out{SweepEntries(points.size())};
    const std::string file = name + ".json";
    std::error_code unreadable;
    if (!std::filesystem::exists(file, unreadable)) return out;
    constexpr std::uint64_t kLargestSweepBytes = std::uint64_t{1} << 30;
    const Json old = parseOrderedJson(readTextFile(file, ExitCode::input, kLargestSweepBytes),
                                      "--resume: '" + file + "'", ExitCode::input);
    if (member(old, "kind") != Json(kKind) || !member(old, "points").is_array()) {
        throw Error(ExitCode::input, "--resume: '" + file + "' is no sweep's");
    }
    for (const auto& [path, what] : std::initializer_list<std::pair<const char*, const char*>>{
             {"schema", "another schema"},
             {"scene.hash", "another scene"},
             {"viewsHash", "other views in the file"},
             {"program.commit", "another version of this program"},
             {"gl.renderer", "another machine"},
             {"host.cpu", "another machine"},
             {"frames", "other numbers of frames"},
             {"search", "another aim of the search"}}) {
        if (member(old, path) != member(head, path)) {
            throw Error(ExitCode::usage, "--resume: '" + file + "' was measured with " + what +
                                             "; without --resume it is made anew");
        }
    }
    // Errors against references that nobody asked for then.
    if (!references.empty() && member(old, "references") != Json(true)) return out;
    const Json& vary = member(head, "search.vary.key");
    const auto compared = [&](Json settings) {
        if (vary.is_string() && settings.is_object()) settings.erase(vary.get<std::string>());
        return settings;
    };
    for (const Json& entry : old.at("points")) {
        const bool wanted = std::any_of(points.begin(), points.end(), [&](const SweepPoint& point) {
            return compared(toJson(point.settings)) == compared(member(entry, "settings"));
        });
        if (!wanted && member(entry, "refusal").is_null()) ++out.others;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Json wanted = compared(toJson(points[i].settings));
        for (const Json& entry : old.at("points")) {
            if (!member(entry, "refusal").is_null() || lacksWhatIsThere(entry, references) ||
                compared(member(entry, "settings")) != wanted)
                continue;
            out.entries[i] = {{"values", sweepValues(axes, points[i])}};
            for (const auto& [key, value] : entry.items()) {
                if (key != "values") out.entries[i][key] = value;
            }
            break;
        }
    }
    return out;
}

}  // namespace mv
