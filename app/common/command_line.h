#pragma once
// The command line of both programs: a flag for every setting of settings_table.h and for every
// RunOptions member. Values are taken in the order defaults, configuration file, preset, state,
// command line.

#include <functional>
#include <string>
#include <vector>

#include "app/common/run_options.h"
#include "app/common/state.h"
#include "megaviews/settings/settings.h"

namespace mv {

struct CommandLine {
    Settings settings;
    RunOptions run;
    std::string reply;  // not empty: --help or --version asked for this text and nothing else
};

// A group of options that one program has: the viewer takes all, the benchmark only those it can
// follow.
enum class OptionSet { viewer, benchmark };

// A program's own options, beyond the shared ones.
struct ExtraOption {
    std::string name;       // "sweep"
    std::string valueName;  // "KEY=VALUES"; empty: the option takes no value
    std::string help;
    std::function<void(const std::string& value)> take;  // each time the option is given
};

struct ProgramInfo {
    std::string name;                    // "megaviews"
    std::string description;             // one sentence
    std::vector<std::string> libraries;  // "GLFW 3.3.8": what --version lists
    OptionSet options = OptionSet::viewer;
    std::vector<ExtraOption> extra = {};
    ReadPictureState readPictureState = {};  // for --load-state; needed by the viewer only
    RunOptions run = {};                     // what holds where the line says nothing
};

// `arguments` without the program's name. Throws Error(ExitCode::usage) with one line that names
// the flag, and Error(ExitCode::input) for a bad state; nothing is opened but the files of
// configuration, state and actions.
CommandLine parseCommandLine(const std::vector<std::string>& arguments, const ProgramInfo& program);

}  // namespace mv
