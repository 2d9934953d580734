// megaviews-bench: measures the many-view methods, and tests the GPU against the CPU. Links neither
// a window system nor an image library, and carries its shaders, so that it runs on bare machines.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/bench/benchmark.h"
#include "app/bench/compare.h"
#include "app/bench/self_test.h"
#include "app/bench/stress.h"
#include "app/common/command_line.h"
#include "app/common/output_names.h"
#include "app/common/run_statistics.h"
#include "app/common/terminal.h"
#include "megaviews/io/output_file.h"
#include "megaviews/settings/error.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/context.h"

namespace mv {
namespace {

constexpr const char* kUsage =
    "Usage: megaviews-bench COMMAND [OPTIONS] [SCENE]\n"
    "  run       time methods over a list of view counts; 'run --help' lists the options\n"
    "  compare   print the errors of one picture against another; 'compare --help' says how\n"
    "  selftest  compare the GPU with the CPU on small cases; exit code 1 if they differ\n"
    "  stress    run hard numerical cases through the whole line; 'stress --help' says how\n"
    "  --help, --version\n";

std::vector<std::string> splitAtCommas(const std::string& text) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = text.find(',', begin);
        parts.push_back(text.substr(begin, end - begin));
        if (end == std::string::npos) return parts;
        begin = end + 1;
    }
}

int runSweep(const std::vector<std::string>& arguments) {
    std::string counts = "1K,4K,16K", methods = "megaviews,manylods", jsonFile, csvFile;
    const ProgramInfo program = {
        "megaviews-bench run",
        "Times many-view methods on a scene over a list of view counts.",
        {},
        OptionSet::benchmark,
        {{"views-list", "N,N,...", "View counts to measure. [1K,4K,16K]", &counts},
         {"methods", "NAME,NAME", "Methods to measure in turn. [megaviews,manylods]", &methods},
         {"json", "FILE.json", "Write everything measured as JSON.", &jsonFile},
         {"csv", "FILE.csv", "Write one line a method and count.", &csvFile}}};
    CommandLine line = parseCommandLine(arguments, program);
    if (!line.reply.empty()) {
        std::fputs(line.reply.c_str(), stdout);
        return static_cast<int>(ExitCode::ok);
    }
    startLogging(line.run);

    BenchmarkRequest request;
    Settings check;
    for (const std::string& text : splitAtCommas(counts)) {
        setFromText(check, *findSetting("vpls"), text, "--views-list");
        request.viewCounts.push_back(check.vpls);
    }
    for (const std::string& text : splitAtCommas(methods)) {
        setFromText(check, *findSetting("method"), text, "--methods");
        request.methods.push_back(check.method);
    }
    request.warmup = line.run.warmup > 0 ? line.run.warmup : request.warmup;
    request.frames = line.run.frames > 1 ? line.run.frames : request.frames;
    if (!line.run.isGiven("resolution")) {
        line.settings.width = 640;
        line.settings.height = 360;
    }
    std::vector<std::string> files;
    for (const std::string& file : {jsonFile, csvFile}) {
        if (!file.empty()) files.push_back(file);
    }
    checkWritable(files);

    noteInterrupts();
    std::unique_ptr<SceneAssets> assets;
    {
        TerminalProgress progress(line.run.logLevel >= LogLevel::error);
        assets = loadAssets(line.run.scene, line.settings,
                            line.run.useCache ? defaultCacheDirectory() : std::filesystem::path(),
                            progress.callback());
    }
    const gl::HeadlessContext context;
    spdlog::info("{}, {}", gl::limits().renderer, gl::limits().version);
    const std::vector<BenchmarkRow> rows = runBenchmark(*assets, line.settings, request);
    std::fputs(benchmarkTable(rows).c_str(), stdout);
    if (!jsonFile.empty())
        writeJson(jsonFile, benchmarkJson(rows, *assets, line.settings, request));
    if (!csvFile.empty()) {
        OutputFile file(csvFile);
        file.write(benchmarkCsv(rows));
        file.commit();
    }
    const bool refused = std::any_of(rows.begin(), rows.end(),
                                     [](const BenchmarkRow& row) { return !row.refusal.empty(); });
    return static_cast<int>(refused ? ExitCode::impossible : ExitCode::ok);
}

int selfTest(const std::vector<std::string>& arguments) {
    if (!arguments.empty()) {
        throw Error(ExitCode::usage, "selftest: takes no argument, got '" + arguments[0] + "'");
    }
    startLogging({});
    const gl::HeadlessContext context;
    std::printf("%s, %s (%s)\n", gl::limits().renderer.c_str(), gl::limits().version.c_str(),
                gl::limits().platform.c_str());
    std::size_t failed = 0;
    const std::vector<Check> checks = runSelfTest();
    for (const Check& check : checks) {
        failed += !check.passed;
        std::printf("%s  %s: %s\n", check.passed ? "pass" : "FAIL", check.name.c_str(),
                    check.detail.c_str());
    }
    std::printf("%zu of %zu checks passed\n", checks.size() - failed, checks.size());
    return static_cast<int>(failed ? ExitCode::checkFailed : ExitCode::ok);
}

int run(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string command = arguments.empty() ? "" : arguments.front();
    const std::vector<std::string> rest(arguments.begin() + (arguments.empty() ? 0 : 1),
                                        arguments.end());
    if (command == "run") return runSweep(rest);
    if (command == "compare") return compareFiles(rest);
    if (command == "selftest") return selfTest(rest);
    if (command == "stress") return stress::stressCommand(rest);
    if (command == "--help" || command == "-h") {
        std::fputs(kUsage, stdout);
        return static_cast<int>(ExitCode::ok);
    }
    if (command == "--version") {
        std::fputs(parseCommandLine({"--version"}, {"megaviews-bench", "", {}}).reply.c_str(),
                   stdout);
        return static_cast<int>(ExitCode::ok);
    }
    const std::vector<std::string> commands = {"run", "compare", "selftest", "stress"};
    const std::string nearest = nearestName(command, commands);
    throw Error(ExitCode::usage, command.empty()
                                     ? "a command is missing: run, compare, selftest or stress"
                                     : "unknown command " + command +
                                           (nearest.empty() ? "; run, compare, selftest or stress"
                                                            : "; did you mean " + nearest + "?"));
}

}  // namespace
}  // namespace mv

int main(int argc, char** argv) { return mv::runProgram("megaviews-bench", mv::run, argc, argv); }
