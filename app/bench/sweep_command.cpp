#include "app/bench/sweep_command.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>

#include "app/bench/sweep.h"
#include "app/bench/sweep_grid.h"
#include "app/bench/sweep_output.h"
#include "app/common/command_line.h"
#include "app/common/output_names.h"
#include "app/common/terminal.h"
#include "megaviews/core/error.h"
#include "megaviews/hierarchy/scene_hierarchy.h"
#include "megaviews/measure/measurement.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

struct Options {
    std::vector<std::string> sweeps;
    std::string out, references, equalTime, equalError, vary;
    bool resume = false;
};

ProgramInfo programInfo(Options& o) {
    ProgramInfo program;
    program.name = "megaviews-bench sweep";
    program.description =
        "Measures time, pairs, memory and error over a grid of settings (docs/benchmark.md).";
    program.options = OptionSet::benchmark;
    program.extra = {
        {"sweep", "KEY=VALUES",
         "An axis of the grid: a setting by its key, and a,b,c or 1K..64K:x2 or 16..64:+16; "
         "repeatable. distribution=single,bounces,particles,random places the views. "
         "[method=megaviews,manylods, vpls=1K,4K,16K]",
         [&o](const std::string& text) { o.sweeps.push_back(text); }},
        {"out", "NAME", "Write NAME.json and NAME.csv, anew after every point.",
         [&o](const std::string& text) {
             const std::string ending = extensionOf(text);
             const bool ofEither = ending == ".json" || ending == ".csv";
             o.out = text.substr(0, text.size() - (ofEither ? ending.size() : 0));
         }},
        {"resume", "", "Take points that NAME.json has already from there.",
         [&o](const std::string&) { o.resume = true; }},
        {"references", "DIR",
         "Measure errors against the pictures that megaviews --references DIR made.",
         [&o](const std::string& text) { o.references = text; }},
        {"equal-time", "MS",
         "For every point, find the value of --vary that takes this long for indirect light.",
         [&o](const std::string& text) { o.equalTime = text; }},
        {"equal-error", "METRIC:VALUE",
         "For every point, find the value of --vary that reaches this error; METRIC may be "
         "pathtraced.METRIC.",
         [&o](const std::string& text) { o.equalError = text; }},
        {"vary", "KEY=VALUES", "What --equal-time and --equal-error vary, cheapest first.",
         [&o](const std::string& text) { o.vary = text; }}};
    program.run.frames = 5;
    program.run.warmup = 1;
    return program;
}

std::optional<SweepSearch> searchOf(const Options& o) {
    const bool time = !o.equalTime.empty(), error = !o.equalError.empty();
    if (time && error) refuse("--equal-time: excludes --equal-error");
    if (!time && !error) {
        if (!o.vary.empty()) refuse("--vary: needs --equal-time or --equal-error");
        return std::nullopt;
    }
    const std::string flag = time ? "--equal-time" : "--equal-error";
    if (o.vary.empty()) refuse(flag + ": needs --vary KEY=VALUES");
    SweepSearch search;
    search.vary = sweepAxisFromText(o.vary, "--vary");
    if (search.vary.key == "method" || search.vary.key == kDistributionKey) {
        refuse("--vary: '" + search.vary.key + "' has no order; --sweep takes it");
    }
    if (time) {
        search.limit = numberFromText(o.equalTime, 1e-6, 1e9, false, flag);
        return search;
    }
    search.goal = SweepSearch::Goal::error;
    std::string text = o.equalError;
    for (const ErrorAgainst against : {ErrorAgainst::exact, ErrorAgainst::pathtraced}) {
        const std::string prefix = std::string(nameOf(against)) + ".";
        if (!text.starts_with(prefix)) continue;
        search.against = against;
        text = text.substr(prefix.size());
        break;
    }
    const Threshold threshold = thresholdFromText(text, flag);
    search.metric = threshold.metric;
    search.limit = threshold.value;
    if (o.references.empty()) refuse("--equal-error: needs --references DIR");
    return search;
}

SweepRequest requestOf(const Options& o, const CommandLine& line) {
    SweepRequest request;
    request.scene = line.run.scene;
    if (line.run.useCache) request.cacheFolder = defaultCacheDirectory();
    request.referencesFolder = o.references;
    request.base = line.settings;
    if (line.settings.compare) {
        refuse("--compare: a sweep measures one method a point; --sweep method=A,B takes two");
    }
    // Each point stands alone.
    request.base.picture.view = DebugView::final;
    request.base.picture.accumulate = request.base.picture.pixelSamples = 1;
    request.base.gather.history = 0;
    for (const char* key : {"view", "accumulate", "pixel-samples", "history"}) {
        const SettingInfo& setting = *findSetting(key);
        if (toText(line.settings, setting) == toText(request.base, setting)) continue;
        spdlog::warn("{} {}: not used, a sweep measures the final picture of one set of samples",
                     key, toText(line.settings, setting));
    }
    request.warmup = line.run.warmup;
    request.frames = line.run.frames;
    request.quiet = line.run.logLevel >= LogLevel::error;
    std::vector<std::string> sweeps = o.sweeps;
    if (sweeps.empty()) sweeps = {"vpls=1K,4K,16K", "method=megaviews,manylods"};
    for (const std::string& text : sweeps) {
        request.axes.push_back(sweepAxisFromText(text, "--sweep"));
    }
    request.search = searchOf(o);
    request.check();
    if (request.referencesFolder.empty()) {
        for (const SweepPoint& point : request.points()) {
            if (!isReference(point.settings.side[0].method)) continue;
            refuse("method " + std::string(nameOf(point.settings.side[0].method)) +
                   ": needs --references DIR");
        }
    }
    return request;
}

// The command, quoted so that a shell reads it again.
std::string commandText(const std::vector<std::string>& arguments) {
    std::string out = "megaviews-bench sweep";
    for (const std::string& argument : arguments) {
        const bool safe = !argument.empty() &&
                          argument.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                              "_-+=:,./%@") == std::string::npos;
        if (safe) {
            out += " " + argument;
            continue;
        }
        out += " '";
        for (const char c : argument) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
        out += "'";
    }
    return out;
}

std::vector<std::string> outputFilesOf(const Options& options, const CommandLine& line) {
    std::vector<std::string> files = outputFiles(line.run);
    if (options.out.empty()) return files;
    files.insert(files.end(), {options.out + ".json", options.out + ".csv"});
    return files;
}

}  // namespace

int sweepCommand(const std::vector<std::string>& arguments) {
    Options options;
    const ProgramInfo program = programInfo(options);
    CommandLine line = parseCommandLine(arguments, program);
    if (!line.reply.empty()) {
        std::fputs(line.reply.c_str(), stdout);
        return static_cast<int>(ExitCode::ok);
    }
    const std::vector<std::string> outputs = outputFilesOf(options, line);
    checkApart(inputFiles(line.run, line.settings), outputs);
    checkWritable(outputs);
    startLogging(line.run);
    if (!line.run.isGiven("resolution")) {
        line.settings.resolution = {640, 360};
    }
    if (options.resume && options.out.empty()) refuse("--resume: needs --out NAME");
    const SweepRequest request = requestOf(options, line);
    const bool files = !options.out.empty();

    noteInterrupts();
    Sweep sweep(request);
    checkApart(sweep.assets().scene.files, outputs);
    const gl::HeadlessContext context(line.run.glWish);
    spdlog::info("{}, {}", gl::limits().renderer, gl::limits().version);
    const std::vector<SweepPoint> points = request.points();
    const nlohmann::ordered_json head = sweepHead(request, sweep.assets(), commandText(arguments));
    SweepEntries entries(points.size());
    if (options.resume) {
        auto [old, others] =
            resumedPoints(options.out, head, points, request.axes, request.referencesFolder);
        if (others > 0) {
            throw Error(ExitCode::usage, "--resume: '" + options.out + ".json' holds " +
                                             std::to_string(others) +
                                             " points that this sweep has not: another --out keeps "
                                             "them; without --resume it is made anew");
        }
        entries = std::move(old);
    }
    std::vector<bool> skip(points.size());
    std::transform(entries.begin(), entries.end(), skip.begin(),
                   [](const auto& entry) { return !entry.is_null(); });
    const auto finished = [&] {
        return std::count_if(entries.begin(), entries.end(),
                             [](const auto& entry) { return !entry.is_null(); });
    };
    if (finished() > 0) spdlog::info("{} of {} points are there", finished(), points.size());
    const auto sayHowFar = [&] {
        std::fputs(sweepTable(head, entries).c_str(), stdout);
        if (!files) return;
        spdlog::warn("interrupted: {} of {} points are in {}.json; --resume goes on", finished(),
                     points.size(), options.out);
    };
    KeptWhenEnded kept(sayHowFar);
    try {
        sweep.run(points, skip, [&](std::size_t index, nlohmann::ordered_json entry) {
            {
                const auto lock = kept.lock();
                entries[index] = std::move(entry);
            }
            const auto& point = entries[index];
            const std::string name = sweepPointName(request.axes, points[index].values);
            const bool refused = point.at("refusal").is_string();
            const auto& ms = refused ? point.at("refusal") : point.at("ms").at("indirect");
            spdlog::info("{} of {}: {}: {}", finished(), points.size(), name,
                         ms.is_object()   ? fmt::format("{:.2f} ms", ms.at("median").get<double>())
                         : ms.is_string() ? ms.get<std::string>()
                                          : "read");
            if (files) writeSweep(options.out, head, entries);
        });
    } catch (const Cancelled&) {
        sayHowFar();
        throw;
    }
    if (files) writeSweep(options.out, head, entries);
    std::fputs(sweepTable(head, entries).c_str(), stdout);
    const bool refused = std::any_of(entries.begin(), entries.end(), [](const auto& entry) {
        return entry.at("refusal").is_string();
    });
    return static_cast<int>(refused ? ExitCode::impossible : ExitCode::ok);
}

}  // namespace mv
