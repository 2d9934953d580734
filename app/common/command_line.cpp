#include "app/common/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>

#include "app/common/output_names.h"
#include "megaviews/core/error.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"

namespace mv {
namespace {

// One option that is no setting.
struct RunFlag {
    std::string names;      // CLI11's form: "-o,--output"
    std::string valueName;  // empty: the option takes no value
    std::string group;
    std::string help;
    OptionSet onlyIn;  // viewer: the benchmark does not know it; benchmark: both do
    std::function<void(RunOptions&, const std::string& text, const std::string& where)> apply;
};

void requireExtension(const std::string& file, const std::vector<std::string>& allowed,
                      const std::string& where) {
    const std::string extension = extensionOf(file);
    if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return;
    std::string list;
    for (const std::string& name : allowed) list.append(list.empty() ? "" : " or ").append(name);
    throw Error(ExitCode::usage,
                where + ": '" + file + "' must end in " + list + ": it chooses the format");
}

template <typename Enum>
Enum oneOf(const std::string& text, const std::vector<std::string>& names,
           const std::string& where) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (text == names[i]) return static_cast<Enum>(i);
    }
    std::string list;
    for (const std::string& name : names) list.append(list.empty() ? "" : ", ").append(name);
    const std::string nearest = nearestName(text, names);
    throw Error(ExitCode::usage, where + ": '" + text + "' is not one of " + list +
                                     (nearest.empty() ? "" : "; did you mean " + nearest + "?"));
}

int wholeNumber(const std::string& text, double minimum, double maximum, const std::string& where) {
    return static_cast<int>(numberFromText(text, minimum, maximum, true, where));
}

std::string metricNames() {
    std::string names;
    for (const MetricInfo& info : metricsTable()) {
        names.append(names.empty() ? "" : ", ").append(info.name);
    }
    return names;
}

std::vector<RunFlag> runFlags() {
    using R = RunOptions;
    using T = const std::string&;
    constexpr auto viewer = OptionSet::viewer;
    constexpr auto both = OptionSet::benchmark;
    return {
        {"--headless", "", "Output", "Render without a window; needs no display.", viewer,
         [](R& r, T, T) { r.headless = true; }},
        {"--gl", "auto|window|egl", "Output",
         "Where OpenGL comes from: a window, EGL without a display, or whichever works.", viewer,
         [](R& r, T text, T where) {
             r.gl = oneOf<GlPlatform>(text, {"auto", "window", "egl"}, where);
         }},
        {"-o,--output", "FILE.png|FILE.exr", "Output",
         "Write the picture: PNG as displayed, EXR as linear radiance; repeatable. With --frames, "
         "{frame} or {frame:04} in the name becomes the frame's number.",
         viewer,
         [](R& r, T text, T where) {
             requireExtension(text, {".png", ".exr"}, where);
             r.outputs.push_back(text);
         }},
        {"--frames", "N", "Output", "Frames to render, one after another in time.", both,
         [](R& r, T text, T where) { r.frames = wholeNumber(text, 1, 1e6, where); }},
        {"--warmup", "N", "Output", "Frames to render before the first that counts.", both,
         [](R& r, T text, T where) { r.warmup = wholeNumber(text, 0, 1e6, where); }},
        {"--frame-rate", "F", "Output", "Frames a second of the animation.", both,
         [](R& r, T text, T where) {
             r.frameRate = numberFromText(text, 1e-3, 1e6, false, where);
         }},
        {"--save-views", "FILE.ply", "Output", "Write the views of the last frame.", viewer,
         [](R& r, T text, T where) {
             requireExtension(text, {".ply"}, where);
             r.saveViewsFile = text;
         }},
        {"--save-maps", "FILE.npy", "Output",
         "Write the depth maps of the last frame, with FILE.centres.npy and FILE.views.npy.",
         viewer,
         [](R& r, T text, T where) {
             requireExtension(text, {".npy"}, where);
             r.saveMapsFile = text;
         }},
        {"--stats", "FILE.json", "Measure", "Write times, counters and memory as JSON.", viewer,
         [](R& r, T text, T) { r.statsFile = text; }},
        {"--references", "DIR", "Output",
         "Keep references here, not in the cache: pictures of the methods exact and pathtraced, "
         "exact maps.",
         viewer, [](R& r, T text, T) { r.referencesFolder = text; }},
        {"--map-references", "N", "Measure",
         "Make exact maps by rays for N of the last frame's views, or for all if there are fewer, "
         "and measure the method's maps against them: in --stats as mapErrors, in the window in "
         "the Errors panel, which it opens. [0]",
         viewer, [](R& r, T text, T where) { r.mapReferences = wholeNumber(text, 0, 1e6, where); }},
        {"--reference", "FILE.exr|FILE.png", "Measure",
         "Measure the last frame's picture against this one: floating point is radiance, whole "
         "numbers are display values.",
         viewer, [](R& r, T text, T) { r.measure.referenceFile = text; }},
        {"--metrics", "all|NAME,NAME", "Measure",
         "Errors to print, one a line: " + metricNames() + ". [all that the reference allows]",
         viewer, [](R& r, T text, T where) { r.measure.metrics = metricsFromText(text, where); }},
        {"--threshold", "METRIC:VALUE", "Measure",
         "Leave with exit code 1 if an error is larger, or a psnr or ssim lower; repeatable.",
         viewer,
         [](R& r, T text, T where) {
             r.measure.thresholds.push_back(thresholdFromText(text, where));
         }},
        {"--diff", "FILE.png|FILE.exr", "Measure",
         "Write where the picture differs: FLIP in colours, or its values from 0 to 1.", viewer,
         [](R& r, T text, T where) {
             requireExtension(text, {".png", ".exr"}, where);
             r.measure.diffFile = text;
         }},
        {"--save-state", "FILE.json", "Output",
         "Write scene, camera and settings when done: what --load-state restores.", viewer,
         [](R& r, T text, T where) {
             requireExtension(text, {".json"}, where);
             r.saveStateFile = text;
         }},
        {"--ui", "", "Output", "With --headless: draw the whole window, panels included.", viewer,
         [](R& r, T, T) { r.ui = true; }},
        {"--actions", "COMMANDS|@FILE", "Output",
         "Do what a user would: action names, KEY=VALUE, mouse and keyboard commands, separated by "
         "';' (docs/command-line.md).",
         viewer, [](R& r, T text, T where) { r.actions = script::parseOption(text, where); }},
        {"--deterministic", "", "Setup",
         "Step the window's animation by the frame rate, not by the clock.", viewer,
         [](R& r, T, T) { r.deterministic = true; }},
        {"--no-cache", "", "Setup", "Neither read nor write the cache of scene hierarchies.", both,
         [](R& r, T, T) { r.useCache = false; }},
        {"--ui-scale", "F", "Setup", "Size of the panels; 0 asks the display.", viewer,
         [](R& r, T text, T where) { r.uiScale = numberFromText(text, 0, 8, false, where); }},
        {"--no-vsync", "", "Setup", "Do not wait for the display between frames.", viewer,
         [](R& r, T, T) { r.vsync = false; }},
        {"--info", "text|json", "Inform",
         "Print what the scene holds and the settings in effect, and do not render (--info=json "
         "for programs).",
         viewer,
         [](R& r, T text, T where) {
             r.info = oneOf<InfoFormat>(text, {"", "text", "json"}, where);
         }},
        {"--list", "cameras|animations|methods|views|presets|actions|metrics", "Inform",
         "Print the names that an option takes, one a line.", viewer,
         [](R& r, T text, T where) {
             const std::vector<std::string> kinds = {"cameras", "animations", "methods", "views",
                                                     "presets", "actions",    "metrics"};
             oneOf<int>(text, kinds, where);
             r.list = text;
         }},
        {"--log-level", "debug|info|warning|error|quiet", "Inform",
         "How much is said on standard error.", both,
         [](R& r, T text, T where) {
             r.logLevel =
                 oneOf<LogLevel>(text, {"debug", "info", "warning", "error", "quiet"}, where);
         }},
        {"--log-file", "FILE", "Inform", "Write everything that is logged to a file as well.", both,
         [](R& r, T text, T) { r.logFile = text; }},
        {"-q,--quiet", "", "Inform", "Say errors only.", both,
         [](R& r, T, T) { r.logLevel = LogLevel::error; }},
        {"-v,--verbose", "", "Inform", "Say more.", both,
         [](R& r, T, T) { r.logLevel = LogLevel::debug; }},
    };
}

constexpr const char* kFooter =
    "Counts accept the suffixes K (1024) and M (1048576): 64K views are 65536. The first of "
    "defaults, configuration file, preset, state and command line is the weakest.\n"
    "Exit codes: 0 done; 1 NaN or infinity in a picture, or a threshold or expectation not met; 2 "
    "usage; 3 "
    "input; 4 no OpenGL 4.5; 5 "
    "output cannot be written; 6 cannot fit; 130 interrupted.";

struct Parser {
    CLI::App app;
    std::map<const CLI::Option*, std::function<void(CommandLine&, const std::string&)>> actions;
    std::vector<std::string> names;  // of long options, for suggestions
    std::map<const CLI::Option*, std::size_t> used;

    explicit Parser(const ProgramInfo& program) : app(program.description, program.name) {
        app.allow_extras();
        app.set_help_flag();  // handled before parsing
        app.footer(kFooter);
        app.get_formatter()->column_width(38);
    }

    void add(const std::string& flags, const std::string& valueName, const std::string& group,
             const std::string& help, std::function<void(CommandLine&, const std::string&)> act) {
        CLI::Option* option = valueName.empty() ? app.add_flag(flags) : app.add_option(flags);
        option->description(help)->group(group);
        if (!valueName.empty()) {
            option->type_name(valueName)->type_size(1)->expected(1)->allow_extra_args(false);
            option->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
        }
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        actions[option] = std::move(act);
    }
};

[[noreturn]] void refuseUnknown(const std::string& argument, const Parser& parser) {
    const std::string option = argument.substr(0, argument.find('='));
    if (!option.starts_with("-")) {
        throw Error(ExitCode::usage, "'" + option + "': only one scene can be given");
    }
    const std::string nearest = nearestName(option, parser.names);
    throw Error(ExitCode::usage,
                "unknown option " + option +
                    (nearest.empty() ? "; --help lists all" : "; did you mean " + nearest + "?"));
}

void applySetting(CommandLine& line, const SettingInfo& setting, const std::string& text,
                  const std::string& where) {
    setFromText(line.settings, setting, text, where);
    line.run.given.emplace_back(setting.key);
}

void applyPair(CommandLine& line, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        throw Error(ExitCode::usage, "-D: '" + text + "' is not KEY=VALUE");
    }
    const std::string key = text.substr(0, equals);
    const SettingInfo* setting = findSetting(key);
    if (!setting) {
        std::vector<std::string> keys;
        for (const SettingInfo& known : settingsTable()) keys.emplace_back(known.key);
        const std::string nearest = nearestName(key, keys);
        throw Error(ExitCode::usage,
                    "-D: unknown setting '" + key + "'" +
                        (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
    }
    applySetting(line, *setting, text.substr(equals + 1), "-D " + key);
}

void applyConfig(CommandLine& line, const std::string& file) {
    for (const std::string& key : applyConfigFile(line.settings, file)) {
        line.run.given.push_back(key);
    }
}

void applyPresetNamed(CommandLine& line, const std::string& name) {
    const PresetInfo* preset = findPreset(name);
    if (!preset) {
        std::vector<std::string> names;
        for (const PresetInfo& known : presetsTable()) names.emplace_back(known.name);
        oneOf<int>(name, names, "--preset");
    }
    for (std::string& key : applyPreset(line.settings, *preset)) {
        line.run.given.push_back(std::move(key));
    }
}

// A state is a whole: what stood there before is forgotten.
void applyState(CommandLine& line, const std::string& file, const ProgramInfo& program,
                bool sceneGiven) {
    const State state = loadState(file, program.readPictureState);
    line.settings = state.settings;
    for (const SettingInfo& setting : settingsTable()) line.run.given.emplace_back(setting.key);
    line.run.playing = state.playing;
    line.run.speed = state.speed;
    if (sceneGiven) return;
    requireScene(state, file);
    line.run.scene = state.scene;
    line.run.sceneSha256 = state.sceneSha256;
}

// A camera chosen by name on the line stands where it stands, not where the state's stood.
void forgetCamera(Settings& settings) {
    for (const char* key : {"camera-position", "camera-target", "camera-up", "fov"}) {
        reset(settings, *findSetting(key));
    }
}

void addOptions(Parser& parser, const ProgramInfo& program) {
    for (const SettingInfo& setting : settingsTable()) {
        std::string help(setting.help);
        const std::string value = toText(Settings{}, setting);
        if (!value.empty()) {
            help.append(" [").append(value);
            if (!setting.unit.empty()) help.append(" ").append(setting.unit);
            help.append("]");
        }
        parser.add("--" + std::string(setting.key), valueRange(setting),
                   std::string(groupTitle(setting.group)), help,
                   [&setting](CommandLine& line, const std::string& text) {
                       applySetting(line, setting, text, "--" + std::string(setting.key));
                   });
    }
    for (const ExtraOption& extra : program.extra) {
        parser.add("--" + extra.name, extra.valueName, "Benchmark", extra.help,
                   [&extra](CommandLine&, const std::string& text) { extra.take(text); });
    }
    for (const RunFlag& flag : runFlags()) {
        if (flag.onlyIn == OptionSet::viewer && program.options != OptionSet::viewer) continue;
        const std::string where = flag.names.substr(flag.names.find("--"));
        parser.add(flag.names, flag.valueName, flag.group, flag.help,
                   [apply = flag.apply, where](CommandLine& line, const std::string& text) {
                       apply(line.run, text, where);
                   });
    }
    parser.add("-D", "KEY=VALUE", "Setup", "Give a setting by its key; repeatable.",
               [](CommandLine& line, const std::string& text) { applyPair(line, text); });
}

std::string versionText(const ProgramInfo& program) {
    std::string text = program.name + " " + programVersion();
    const std::string commit = programCommit();
    text.append(" (").append(commit.empty() ? "no commit" : "commit " + commit);
    text.append(", ").append(programBuildType()).append(")\n");
    for (const std::string& library : program.libraries) text.append("  ").append(library + "\n");
    return text;
}

}  // namespace

bool RunOptions::isGiven(const std::string& key) const {
    return std::find(given.begin(), given.end(), key) != given.end();
}

std::string programVersion() { return MEGAVIEWS_VERSION; }
std::string programCommit() { return MEGAVIEWS_COMMIT; }
std::string programBuildType() { return MEGAVIEWS_BUILD_TYPE; }

CommandLine parseCommandLine(const std::vector<std::string>& arguments,
                             const ProgramInfo& program) {
    CommandLine line;
    line.run = program.run;
    Parser parser(program);
    std::string scene, config, state;
    bool noConfig = false;
    parser.app
        .add_option("SCENE", scene,
                    "A .gltf or .glb file, or builtin:cornell, builtin:atrium, "
                    "builtin:cathedral, builtin:hairball. [builtin:atrium]")
        ->type_name("");
    addOptions(parser, program);
    parser.add("--config", "FILE", "Setup",
               "Read settings from a JSON file instead of " +
                   std::string("$XDG_CONFIG_HOME/megaviews/config.json."),
               [](CommandLine&, const std::string&) {});
    parser.add("--no-config", "", "Setup", "Read no configuration file.",
               [](CommandLine&, const std::string&) {});
    std::string presets;
    for (const PresetInfo& preset : presetsTable()) {
        presets.append(presets.empty() ? "" : "|").append(preset.name);
    }
    parser.add("--preset", presets, "Setup",
               "Take a named set of settings; what else is on the line goes first.",
               [](CommandLine&, const std::string&) {});
    if (program.options == OptionSet::viewer) {
        parser.add("--load-state", "FILE.json|FILE.png|FILE.exr", "Setup",
                   "Restore scene, camera and settings from a saved state, or from a picture that "
                   "this program wrote.",
                   [](CommandLine&, const std::string&) {});
    }
    parser.add("-h,--help", "", "Inform", "Print this and leave.",
               [](CommandLine&, const std::string&) {});
    parser.add("--version", "", "Inform", "Print version, commit and libraries, and leave.",
               [](CommandLine&, const std::string&) {});

    // Help and version answer whatever else is on the line.
    std::vector<std::string> reversed;
    for (const std::string& argument : arguments) {
        if (argument == "-h" || argument == "--help") {
            line.reply = parser.app.help();
            return line;
        }
        if (argument == "--version") {
            line.reply = versionText(program);
            return line;
        }
        // The only option whose value may be left out takes it with '=' alone.
        reversed.push_back(argument == "--info" ? "--info=text" : argument);
    }
    std::reverse(reversed.begin(), reversed.end());
    try {
        parser.app.parse(std::move(reversed));
    } catch (const CLI::ArgumentMismatch& error) {
        const std::string what = error.what();
        throw Error(ExitCode::usage, what.substr(0, what.find(':')) + ": a value is missing");
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, error.what());
    }
    const std::vector<std::string> unknown = parser.app.remaining();
    for (const std::string& argument : unknown) {
        if (argument.starts_with("-")) refuseUnknown(argument, parser);
    }
    if (!unknown.empty()) refuseUnknown(unknown.front(), parser);

    // Weakest first: configuration file, preset, state, then the line from left to right.
    bool cameraGiven = false;
    for (const CLI::Option* option : parser.app.parse_order()) {
        if (option->check_lname("config")) config = option->results().back();
        if (option->check_lname("no-config")) noConfig = true;
        if (option->check_lname("load-state")) state = option->results().back();
        if (option->check_lname("camera")) cameraGiven = true;
    }
    if (!config.empty() && noConfig) {
        throw Error(ExitCode::usage, "--no-config: contradicts --config");
    }
    if (!config.empty()) {
        applyConfig(line, config);
    } else if (!noConfig) {
        const std::string file = defaultConfigFile();
        std::error_code unreadable;  // then it is not there for us
        if (!file.empty() && std::filesystem::exists(file, unreadable)) applyConfig(line, file);
    }
    if (const CLI::Option* preset = parser.app.get_option("--preset")) {
        for (const std::string& name : preset->results()) applyPresetNamed(line, name);
    }
    if (!state.empty()) {
        applyState(line, state, program, !scene.empty());
        if (cameraGiven) forgetCamera(line.settings);
    }
    for (const CLI::Option* option : parser.app.parse_order()) {
        const auto action = parser.actions.find(option);
        if (action == parser.actions.end()) continue;
        const std::size_t index = parser.used[option]++;
        action->second(line, index < option->results().size() ? option->results()[index] : "");
    }
    if (!scene.empty()) line.run.scene = scene;
    for (const CLI::Option* option : parser.app.parse_order()) {
        for (const char* name : {"metrics", "threshold", "diff"}) {
            if (option->check_lname(name) && line.run.measure.referenceFile.empty()) {
                throw Error(ExitCode::usage, std::string("--") + name + ": needs --reference");
            }
        }
    }
    validate(line.settings);
    return line;
}

}  // namespace mv
