#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/bench/stress.h"
#include "app/common/command_line.h"
#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "app/common/terminal.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"

namespace mv::stress {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kUsage =
    "Usage: megaviews-bench stress [OPTIONS]\n"
    "Runs hard numerical cases through the whole line on CPU and GPU; exit code 1 if one fails.\n"
    "  --list       print the cases and why each is hard, and run nothing\n"
    "  --only NAME  run this case alone; may be given again\n"
    "  --json FILE  write what was measured as JSON\n"
    "  --help\n";

struct Options {
    bool help = false, list = false;
    std::vector<const Case*> chosen;
    std::string jsonFile;
};

const Case& caseNamed(const std::string& name) {
    std::vector<std::string> names;
    for (const Case& c : cases()) {
        if (c.name == name) return c;
        names.push_back(c.name);
    }
    const std::string nearest = nearestName(name, names);
    throw Error(ExitCode::usage, "--only: there is no case '" + name + "'" +
                                     (nearest.empty() ? "; --list prints them"
                                                      : "; did you mean '" + nearest + "'?"));
}

Options parse(const std::vector<std::string>& arguments) {
    Options options;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const std::string& flag = arguments[i];
        const auto value = [&]() -> const std::string& {
            if (++i >= arguments.size())
                throw Error(ExitCode::usage, flag + ": a value is missing");
            return arguments[i];
        };
        if (flag == "--help" || flag == "-h") {
            options.help = true;
        } else if (flag == "--list") {
            options.list = true;
        } else if (flag == "--only") {
            options.chosen.push_back(&caseNamed(value()));
        } else if (flag == "--json") {
            options.jsonFile = value();
        } else {
            throw Error(ExitCode::usage,
                        "stress: unknown option '" + flag + "'; --list, --only, --json or --help");
        }
    }
    if (options.chosen.empty())
        for (const Case& c : cases()) options.chosen.push_back(&c);
    return options;
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
            {"pictureGap", finite(r.pictureGap)},
            {"apart", r.apart ? finite(*r.apart) : Json(nullptr)},
            {"ms", r.ms}};
}

}  // namespace

int stressCommand(const std::vector<std::string>& arguments) {
    const Options options = parse(arguments);
    if (options.help) {
        std::fputs(kUsage, stdout);
        return static_cast<int>(ExitCode::ok);
    }
    if (options.list) {
        for (const Case& c : cases())
            std::fputs(fmt::format("{:<24} {}\n", c.name, c.why).c_str(), stdout);
        return static_cast<int>(ExitCode::ok);
    }
    RunOptions log;
    log.logLevel = LogLevel::warning;
    startLogging(log);
    if (!options.jsonFile.empty()) checkWritable({options.jsonFile});
    noteInterrupts();
    const gl::HeadlessContext context;
    Runner runner;
    Json rows = Json::array();
    std::size_t failed = 0;
    std::fputs(tableHeader().c_str(), stdout);
    for (const Case* c : options.chosen) {
        if (interrupted()) throw Cancelled();
        const Result r = runner.run(*c);
        std::fputs(tableRow(r).c_str(), stdout);
        for (const std::string& failure : r.failures)
            std::fprintf(stderr, "%s: %s\n", r.name.c_str(), failure.c_str());
        std::fflush(stdout);
        failed += !r.failures.empty();
        rows.push_back(toJson(r));
    }
    std::printf("%zu of %zu cases passed\n", options.chosen.size() - failed, options.chosen.size());
    if (!options.jsonFile.empty()) {
        writeJson(options.jsonFile, Json{{"schema", 1},
                                         {"program", programJson()},
                                         {"gl", graphicsJson()},
                                         {"host", hostJson()},
                                         {"cases", rows}});
    }
    return static_cast<int>(failed ? ExitCode::checkFailed : ExitCode::ok);
}

}  // namespace mv::stress
