// megaviews-bench: measures the many-view methods, and tests the GPU against the CPU. Links neither
// a window system nor an image library, and carries its shaders, so that it runs on bare machines.

#include <cstdio>

#include "app/bench/compare.h"
#include "app/bench/cuts_command.h"
#include "app/bench/stress.h"
#include "app/bench/sweep_command.h"
#include "app/common/command_line.h"
#include "app/common/terminal.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

constexpr const char* kUsage =
    "Usage: megaviews-bench COMMAND [OPTIONS] [SCENE]\n"
    "  sweep     measure time, memory and error over a grid of settings; 'sweep --help'\n"
    "  compare   print the errors of one picture against another; 'compare --help' says how\n"
    "  cuts      follow ManyLoDs' incremental and lazy cuts; 'cuts --help' says how\n"
    "  selftest  compare the GPU with the CPU on small cases; exit code 1 if they differ\n"
    "  stress    run hard numerical cases through the whole line; 'stress --help' says how\n"
    "  --help, --version\n";

int run(int argc, char** argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    const std::string command = arguments.empty() ? "" : arguments.front();
    const std::vector<std::string> rest(arguments.begin() + (arguments.empty() ? 0 : 1),
                                        arguments.end());
    if (command == "sweep") return sweepCommand(rest);
    if (command == "compare") return compareFiles(rest);
    if (command == "cuts") return cutsCommand(rest);
    if (command == "selftest") return stress::selfTestCommand(rest);
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
    const std::vector<std::string> commands = {"sweep", "compare", "cuts", "selftest", "stress"};
    const std::string all = "sweep, compare, cuts, selftest or stress";
    throw Error(ExitCode::usage, command.empty() ? "a command is missing: " + all
                                                 : "unknown command " + command +
                                                       didYouMean(command, commands, "; " + all));
}

}  // namespace
}  // namespace mv

int main(int argc, char** argv) { return mv::runProgram("megaviews-bench", mv::run, argc, argv); }
