#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/bench/options.h"
#include "app/bench/stress.h"
#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "app/common/terminal.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"

namespace mv::stress {
namespace {

using Json = nlohmann::ordered_json;

const Case& caseNamed(const std::string& name) {
    std::vector<std::string> names;
    for (const Case& c : cases()) {
        if (c.name == name) return c;
        names.push_back(c.name);
    }
    throw Error(ExitCode::usage, "--only: there is no case '" + name + "'" +
                                     didYouMean(name, names, "; --list prints them"));
}

// null where there is no bound.
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json toJson(const Result& r) {
    return {{"case", r.name},
            {"passed", r.failures.empty()},
            {"failures", r.failures},
            {"views", r.views},
            {"badPixels", r.badPixels},
            {"error", finite(r.error)},
            {"leaked", finite(r.leaked)},
            {"errorFactor", finite(r.errorFactor)},
            {"allowedFactor", finite(r.allowedFactor)},
            {"worstSetup", r.worstSetup},
            {"pairsGpu", r.pairsGpu},
            {"pairsCpu", r.pairsCpu},
            {"texels", r.texels},
            {"texelsDiffering", r.texelsDiffering},
            {"viewsDiffering", r.viewsDiffering},
            {"nodesDiffering", r.nodesDiffering},
            {"pictureGap", finite(r.pictureGap)},
            {"apart", r.apart ? finite(*r.apart) : Json(nullptr)},
            {"ms", r.ms}};
}

void addContextOptions(CLI::App& app, gl::ContextWish& wish) {
    app.add_option("--gl-device", wish.device,
                   "Use this device alone: a part of its platform's or renderer's name.")
        ->type_name("NAME");
    app.add_flag("--require-hardware", wish.hardware, "Refuse to render in software: exit code 4.");
}

// Prints a line a case; returns the exit code.
int runCases(const std::vector<const Case*>& chosen, const std::string& jsonFile,
             const gl::ContextWish& wish) {
    RunOptions log;
    log.logLevel = LogLevel::warning;
    startLogging(log);
    if (!jsonFile.empty()) {
        requireJson(jsonFile, "stress: --json");
        checkWritable({jsonFile});
    }
    noteInterrupts();
    const gl::HeadlessContext context(wish);
    std::printf("%s, %s (%s)\n\n", gl::limits().renderer.c_str(), gl::limits().version.c_str(),
                gl::limits().platform.c_str());
    Runner runner;
    Json rows = Json::array();
    const auto writeRows = [&](bool partial) {
        if (jsonFile.empty()) return;
        writeJson(jsonFile, Json{{"schema", 1},
                                 {"program", programJson()},
                                 {"gl", graphicsJson()},
                                 {"host", hostJson()},
                                 {"partial", partial},
                                 {"cases", rows}});
    };
    KeptWhenEnded kept([&] { writeRows(true); });
    std::size_t failed = 0;
    std::fputs(tableHeader().c_str(), stdout);
    for (const Case* c : chosen) {
        if (interrupted()) {
            writeRows(true);
            throw Cancelled();
        }
        const Result r = [&] {
            try {
                return runner.run(*c);
            } catch (...) {
                writeRows(true);
                throw;
            }
        }();
        std::fputs(tableRow(r).c_str(), stdout);
        for (const std::string& failure : r.failures)
            std::fprintf(stderr, "%s: %s\n", r.name.c_str(), failure.c_str());
        std::fflush(stdout);
        failed += !r.failures.empty();
        const auto lock = kept.lock();
        rows.push_back(toJson(r));
    }
    std::printf("%zu of %zu cases passed\n", chosen.size() - failed, chosen.size());
    writeRows(false);
    return static_cast<int>(failed ? ExitCode::checkFailed : ExitCode::ok);
}

}  // namespace

int stressCommand(const std::vector<std::string>& arguments) {
    CLI::App app(
        "Runs hard numerical cases through the whole line on CPU and GPU; exit code 1 if one "
        "fails.",
        "megaviews-bench stress");
    bool list = false;
    std::vector<std::string> only;
    std::string jsonFile;
    app.add_flag("--list", list, "Print the cases and why each is hard, and run nothing.");
    app.add_option("--only", only, "Run this case alone; may be given again.")
        ->type_name("NAME")
        ->allow_extra_args(false);
    app.add_option("--json", jsonFile, "Write what was measured as JSON.")->type_name("FILE");
    gl::ContextWish wish;
    addContextOptions(app, wish);
    if (!parseOptions(app, arguments)) return static_cast<int>(ExitCode::ok);
    if (list) {
        for (const Case& c : cases())
            std::fputs(fmt::format("{:<24} {}\n", c.name, c.why).c_str(), stdout);
        return static_cast<int>(ExitCode::ok);
    }
    std::vector<const Case*> chosen;
    for (const std::string& name : only) chosen.push_back(&caseNamed(name));
    for (const Case& c : cases())
        if (only.empty()) chosen.push_back(&c);
    return runCases(chosen, jsonFile, wish);
}

int selfTestCommand(const std::vector<std::string>& arguments) {
    CLI::App app("Compares the GPU with the CPU on small cases; exit code 1 if they differ.",
                 "megaviews-bench selftest");
    gl::ContextWish wish;
    addContextOptions(app, wish);
    if (!parseOptions(app, arguments)) return static_cast<int>(ExitCode::ok);
    std::vector<const Case*> quick;
    for (const char* name : {"room", "one-view", "no-views", "particles", "view-res-8"})
        quick.push_back(&caseNamed(name));
    return runCases(quick, "", wish);
}

}  // namespace mv::stress
