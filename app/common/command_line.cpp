#include "app/common/command_line.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <type_traits>

#include "app/common/output_names.h"
#include "app/common/program_version.h"
#include "megaviews/core/error.h"
#include "megaviews/core/text.h"
#include "megaviews/scene/load_scene.h"
#include "megaviews/settings/presets.h"
#include "megaviews/settings/settings_table.h"
#include "renderer/gl/workarounds.h"

namespace mv {
namespace {

using Text = const std::string&;
using Apply = std::function<void(RunOptions&, Text value, Text where)>;

// One option that is no setting.
struct RunFlag {
    std::string names;      // CLI11's form: "-o,--output"
    std::string valueName;  // empty: the option takes no value
    std::string group;
    std::string help;
    OptionSet onlyIn;  // viewer: the benchmark does not know it; benchmark: both do
    Apply apply;
};

template <typename Enum>
Enum oneOf(const std::string& text, const std::vector<std::string>& names,
           const std::string& where) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (text == names[i]) return static_cast<Enum>(i);
    }
    throw Error(ExitCode::usage, where + ": " + notOneOf(text, names));
}

template <typename T>
Apply give(T RunOptions::*member, T value) {
    return [=](RunOptions& run, Text, Text) { run.*member = value; };
}

// `endings` empty: any will do.
Apply file(std::string RunOptions::*member, const std::vector<std::string>& endings = {}) {
    return [=](RunOptions& run, Text name, Text where) {
        if (!endings.empty()) requireExtension(name, endings, where);
        run.*member = name;
    };
}

template <typename Number>
Apply number(Number RunOptions::*member, double minimum, double maximum) {
    return [=](RunOptions& run, Text text, Text where) {
        run.*member = static_cast<Number>(
            numberFromText(text, minimum, maximum, std::is_integral_v<Number>, where));
    };
}

template <typename Enum>
Apply choice(Enum RunOptions::*member, const std::vector<std::string>& names) {
    return [=](RunOptions& run, Text text, Text where) {
        run.*member = oneOf<Enum>(text, names, where);
    };
}

std::vector<RunFlag> runFlags() {
    using R = RunOptions;
    constexpr auto viewer = OptionSet::viewer;
    constexpr auto both = OptionSet::benchmark;
    constexpr double kMostFrames = 1e6;
    const std::vector<std::string> pictures = {".png", ".exr"};
    const std::string metrics = joined(namesIn(metricsTable(), &MetricInfo::name), ", ");
    return {
        {"--headless", "", "Output", "Render without a window; needs no display.", viewer,
         give(&R::headless, true)},
        {"--gl", "auto|window|egl", "Output",
         "Where OpenGL comes from: a window, EGL without a display, or whichever works.", viewer,
         choice(&R::gl, {"auto", "window", "egl"})},
        {"--gl-device", "NAME", "Output",
         "Use this device alone: a part of its platform's or renderer's name (\"EGL device 1\", "
         "\"NVIDIA\").",
         both, [](R& r, Text name, Text) { r.glWish.device = name; }},
        {"--require-hardware", "", "Output", "Refuse to render in software: exit code 4.", both,
         [](R& r, Text, Text) { r.glWish.hardware = true; }},
        {"-o,--output", "FILE.png|FILE.exr", "Output",
         "Write the picture: PNG as displayed, EXR as linear radiance; repeatable. With --frames, "
         "{frame} or {frame:04} in the name becomes the frame's number.",
         viewer,
         [=](R& r, Text name, Text where) {
             requireExtension(name, pictures, where);
             r.outputs.push_back(name);
         }},
        {"--frames", "N", "Output", "Frames to render, one after another in time.", both,
         number(&R::frames, 1, kMostFrames)},
        {"--warmup", "N", "Output", "Frames to render before the first that counts.", both,
         number(&R::warmup, 0, kMostFrames)},
        {"--frame-rate", "F", "Output", "Frames a second of the animation.", viewer,
         number(&R::frameRate, 1e-3, 1e6)},
        {"--save-views", "FILE.ply", "Output", "Write the views of the last frame.", viewer,
         file(&R::saveViewsFile, {".ply"})},
        {"--save-maps", "FILE.npy", "Output",
         "Write the depth maps of the last frame, with FILE.centres.npy and FILE.views.npy.",
         viewer, file(&R::saveMapsFile, {".npy"})},
        {"--save-scene", "FILE.glb", "Output",
         "Write the scene as the last frame has it, with its lights and cameras, as binary glTF.",
         viewer, file(&R::saveSceneFile, {".glb"})},
        {"--stats", "FILE.json", "Measure", "Write times, counters and memory as JSON.", viewer,
         [](R& r, Text name, Text where) {
             requireJson(name, where);
             r.statsFile = name;
         }},
        {"--references", "DIR", "Output",
         "Keep references here, not in the cache: pictures of the methods exact and pathtraced, "
         "exact maps.",
         viewer, file(&R::referencesFolder)},
        {"--map-references", "N", "Measure",
         "Make exact maps by rays for N of the last frame's views, or for all if there are fewer, "
         "and measure the method's maps against them: in --stats as mapErrors, in the window in "
         "the Errors panel, which it opens. [0]",
         viewer, number(&R::mapReferences, 0, 1e6)},
        {"--reference", "FILE.exr|FILE.png", "Measure",
         "Measure the last frame's picture against this one: floating point is radiance, whole "
         "numbers are display values.",
         viewer, [](R& r, Text name, Text) { r.measure.referenceFile = name; }},
        {"--metrics", "all|NAME,NAME", "Measure",
         "Errors to print, one a line: " + metrics + ". [all that the reference allows]", viewer,
         [](R& r, Text text, Text where) { r.measure.metrics = metricsFromText(text, where); }},
        {"--threshold", "METRIC:VALUE", "Measure",
         "Leave with exit code 1 if an error is larger, or a psnr or ssim lower; repeatable.",
         viewer,
         [](R& r, Text text, Text where) {
             r.measure.thresholds.push_back(thresholdFromText(text, where));
         }},
        {"--diff", "FILE.png|FILE.exr", "Measure",
         "Write where the picture differs: FLIP in colours, or its values from 0 to 1.", viewer,
         [=](R& r, Text name, Text where) {
             requireExtension(name, pictures, where);
             r.measure.diffFile = name;
         }},
        {"--save-state", "FILE.json", "Output",
         "Write scene, camera and settings when done: what --load-state restores.", viewer,
         file(&R::saveStateFile, {".json"})},
        {"--ui", "", "Output", "With --headless: draw the whole window, panels included.", viewer,
         give(&R::ui, true)},
        {"--actions", "COMMANDS|@FILE", "Output",
         "Do what a user would: action names, KEY=VALUE, mouse and keyboard commands, separated by "
         "';' (docs/command-line.md).",
         viewer,
         [](R& r, Text text, Text where) {
             r.actions = script::parseOption(text, where);
             if (text.starts_with("@")) r.inputs.push_back(text.substr(1));
         }},
        {"--tour", "", "Setup", "Start with the tour: five steps from a view to the error.", viewer,
         [](R& r, Text, Text where) {
             const script::Script tour = script::parse("tour", std::string(where));
             r.actions.insert(r.actions.begin(), tour.begin(), tour.end());
             r.tour = true;
         }},
        {"--deterministic", "", "Setup",
         "Step the window's animation by the frame rate, not by the clock.", viewer,
         give(&R::deterministic, true)},
        {"--no-cache", "", "Setup", "Neither read nor write the cache of scene hierarchies.", both,
         give(&R::useCache, false)},
        {"--ui-scale", "F", "Setup", "Size of the panels, 0.25 to 8; 0 asks the display.", viewer,
         [](R& r, Text text, Text where) {
             const double scale = numberFromText(text, 0, 8, false, where);
             if (scale != 0) numberFromText(text, 0.25, 8, false, where);
             r.uiScale = static_cast<decltype(r.uiScale)>(scale);
         }},
        {"--no-vsync", "", "Setup", "Do not wait for the display between frames.", viewer,
         give(&R::vsync, false)},
        {"--info", "text|json", "Inform",
         "Print what the scene holds and the settings in effect, and do not render (--info json "
         "for programs).",
         viewer, choice(&R::info, {"", "text", "json"})},
        {"--list", "cameras|animations|methods|views|presets|actions|metrics", "Inform",
         "Print the names that an option takes, one a line.", viewer,
         [](R& r, Text text, Text where) {
             oneOf<int>(
                 text,
                 {"cameras", "animations", "methods", "views", "presets", "actions", "metrics"},
                 where);
             r.list = text;
         }},
        {"--log-level", "debug|info|warning|error|quiet", "Inform",
         "How much is said on standard error.", both,
         choice(&R::logLevel, {"debug", "info", "warning", "error", "quiet"})},
        {"--log-file", "FILE", "Inform", "Write everything that is logged to a file as well.", both,
         file(&R::logFile)},
        {"-q,--quiet", "", "Inform", "Say errors only.", both, give(&R::logLevel, LogLevel::error)},
        {"-v,--verbose", "", "Inform", "Say more.", both, give(&R::logLevel, LogLevel::debug)},
    };
}

constexpr const char* kFooter =
    "Counts accept the suffixes K (1024) and M (1048576): 64K views are 65536. The first of "
    "defaults, configuration file, preset, state and command line is the weakest.\n"
    "Exit codes: 0 done; 1 NaN or infinity in a picture, or a threshold or expectation not met; 2 "
    "usage; 3 "
    "input; 4 no OpenGL 4.5; 5 "
    "output cannot be written; 6 cannot fit; 130 interrupted.";

// Declares the options of a program and keeps what the line gives, in the line's order.
struct Parser {
    using Act = std::function<void(CommandLine&, const std::string& text)>;
    CLI::App app;
    std::vector<std::function<void(CommandLine&)>> given;
    struct GivenSetting {
        const SettingInfo* setting;
        std::string text, where;
    };
    std::vector<GivenSetting> settings;
    std::vector<std::string> names;  // of long options, for suggestions
    std::string scene, config, state, preset;

    explicit Parser(const ProgramInfo& program);
    CLI::Option* describe(CLI::Option* option, const std::string& valueName,
                          const std::string& group, const std::string& help);
    CLI::Option* add(const std::string& flags, const std::string& valueName,
                     const std::string& group, const std::string& help, Act act);
    void addSettings();
    void addSources(OptionSet options);
    void parse(std::vector<std::string> arguments);
};

// Applies them in the table's order: the right side of a comparison follows earlier settings.
void applySettings(CommandLine& line, std::vector<Parser::GivenSetting> given) {
    std::stable_sort(given.begin(), given.end(),
                     [](const auto& a, const auto& b) { return a.setting < b.setting; });
    for (const auto& [setting, text, where] : given) {
        setFromText(line.settings, *setting, text, where);
        line.run.given.emplace_back(setting->key);
    }
}

Parser::GivenSetting settingOfPair(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) {
        throw Error(ExitCode::usage, "-D: '" + text + "' is not KEY=VALUE");
    }
    const std::string key = text.substr(0, equals);
    const SettingInfo* setting = findSetting(key);
    if (!setting) {
        throw Error(ExitCode::usage,
                    "-D: unknown setting '" + key + "'" +
                        didYouMean(key, namesIn(settingsTable(), &SettingInfo::key)));
    }
    return {setting, text.substr(equals + 1), "-D " + key};
}

void applyPresetNamed(CommandLine& line, const std::string& name) {
    const PresetInfo* preset = findPreset(name);
    if (!preset) {
        const std::vector<std::string> names = namesIn(presetsTable(), &PresetInfo::name);
        throw Error(ExitCode::usage, "--preset: " + notOneOf(name, names));
    }
    for (std::string& key : applyPreset(line.settings, *preset)) {
        line.run.given.push_back(std::move(key));
    }
}

[[noreturn]] void refuseUnknown(const std::string& argument,
                                const std::vector<std::string>& names) {
    const std::string option = argument.substr(0, argument.find('='));
    if (!option.starts_with("-")) {
        throw Error(ExitCode::usage, "'" + option + "': only one scene can be given");
    }
    throw Error(ExitCode::usage,
                "unknown option " + option + didYouMean(option, names, "; --help lists all"));
}

// An empty value may come from a shell variable that is not set. To ignore it would leave out what
// was asked for without a word.
[[noreturn]] void refuseEmpty(const std::string& name) {
    throw Error(ExitCode::usage, name + ": its value is empty");
}

Parser::Parser(const ProgramInfo& program) : app(program.description, program.name) {
    app.allow_extras();
    app.set_help_flag();  // answered before parsing
    app.footer(kFooter);
    app.get_formatter()->column_width(38);
    app.add_option("SCENE", scene,
                   fmt::format("A .gltf or .glb file, or {}. [{}]", fmt::join(builtinNames(), ", "),
                               RunOptions().scene))
        ->type_name("");
    addSettings();
    for (const ExtraOption& extra : program.extra) {
        add("--" + extra.name, extra.valueName, "Benchmark", extra.help,
            [&extra](CommandLine&, Text text) { extra.take(text); });
    }
    for (const RunFlag& flag : runFlags()) {
        if (flag.onlyIn == OptionSet::viewer && program.options != OptionSet::viewer) continue;
        const std::string where = flag.names.substr(flag.names.find("--"));
        add(flag.names, flag.valueName, flag.group, flag.help,
            [apply = flag.apply, where](CommandLine& line, Text text) {
                apply(line.run, text, where);
            });
    }
    add("-D", "KEY=VALUE", "Setup", "Give a setting by its key; repeatable.",
        [this](CommandLine&, Text text) { settings.push_back(settingOfPair(text)); });
    addSources(program.options);
    if (program.options == OptionSet::viewer) {
        for (const char* name : {"--metrics", "--threshold", "--diff"}) {
            app.get_option(name)->needs(app.get_option("--reference"));
        }
    }
    const auto nothing = [](CommandLine&, Text) {};
    add("-h,--help", "", "Inform", "Print this and leave.", nothing);
    add("--version", "", "Inform", "Print version, commit and libraries, and leave.", nothing);
}

CLI::Option* Parser::describe(CLI::Option* option, const std::string& valueName,
                              const std::string& group, const std::string& help) {
    option->description(help)->group(group);
    if (!valueName.empty()) option->type_name(valueName)->take_last();
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return option;
}

CLI::Option* Parser::add(const std::string& flags, const std::string& valueName,
                         const std::string& group, const std::string& help, Act act) {
    const auto keep = [this, flags, takesValue = !valueName.empty(),
                       act = std::move(act)](Text text) {
        if (takesValue && text.empty()) refuseEmpty(flags.substr(flags.find("--")));
        given.push_back([act, text](CommandLine& line) { act(line, text); });
    };
    CLI::Option* option = valueName.empty() ? app.add_flag_callback(flags, [keep] { keep({}); })
                                            : app.add_option_function<std::string>(
                                                  flags, [keep](Text text) { keep(text); });
    return describe(option, valueName, group, help)->trigger_on_parse();
}

void Parser::addSettings() {
    for (const SettingInfo& setting : settingsTable()) {
        std::string help(setting.help);
        const std::string value = toText(Settings{}, setting);
        if (!value.empty()) {
            help.append(" [").append(value);
            if (!setting.unit.empty()) help.append(" ").append(setting.unit);
            help.append("]");
        }
        const std::string flag = "--" + std::string(setting.key);
        add(flag, valueRange(setting), std::string(groupTitle(setting.group)), help,
            [this, &setting, flag](CommandLine&, Text text) {
                settings.push_back({&setting, text, flag});
            });
    }
}

// Where settings come from beside the line; these are weaker than the line wherever they stand.
void Parser::addSources(OptionSet options) {
    CLI::Option* file = describe(
        app.add_option("--config", config), "FILE", "Setup",
        "Read settings from a JSON file instead of $XDG_CONFIG_HOME/megaviews/config.json.");
    describe(app.add_flag("--no-config"), "", "Setup", "Read no configuration file.")
        ->excludes(file);
    const std::string presets = joined(namesIn(presetsTable(), &PresetInfo::name), "|");
    describe(app.add_option("--preset", preset), presets, "Setup",
             "Take a named set of settings; what else is on the line goes first.");
    if (options != OptionSet::viewer) return;
    describe(app.add_option("--load-state", state), "FILE.json|FILE.png|FILE.exr", "Setup",
             "Restore scene, camera and settings from a saved state, or from a picture that this "
             "program wrote.");
}

void Parser::parse(std::vector<std::string> arguments) {
    std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
    try {
        app.parse(std::move(arguments));
    } catch (const CLI::ArgumentMismatch& error) {
        const std::string what = error.what();
        throw Error(ExitCode::usage, what.substr(0, what.find(':')) + ": a value is missing");
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::usage, error.what());
    }
    for (const char* name : {"SCENE", "--config", "--preset", "--load-state"}) {
        const CLI::Option* source = app.get_option_no_throw(name);
        if (source && source->count() > 0 && source->as<std::string>().empty()) refuseEmpty(name);
    }
    std::vector<std::string> unknown = app.remaining();
    std::erase(unknown, "--");  // what follows it is no option
    const auto option = std::find_if(unknown.begin(), unknown.end(),
                                     [](Text argument) { return argument.starts_with("-"); });
    if (option != unknown.end()) refuseUnknown(*option, names);
    if (!unknown.empty()) refuseUnknown(unknown.front(), names);
}

// The only option whose value may be left out has it with '=' from here on: "--info SCENE" names no
// format.
std::vector<std::string> withInfoFormat(const std::vector<std::string>& arguments) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        out.push_back(arguments[i]);
        if (arguments[i] != "--info") continue;
        const bool named =
            i + 1 < arguments.size() && (arguments[i + 1] == "text" || arguments[i + 1] == "json");
        out.back() += "=" + (named ? arguments[++i] : "text");
    }
    return out;
}

void applyConfig(CommandLine& line, const Parser& parser) {
    std::string file = parser.config;
    if (file.empty() && parser.app.count("--no-config") == 0) {
        file = defaultConfigFile();
        std::error_code unreadable;  // then it is not there for us
        if (!std::filesystem::exists(file, unreadable)) file.clear();
    }
    if (file.empty()) return;
    line.run.inputs.push_back(file);
    for (const std::string& key : applyConfigFile(line.settings, file)) {
        line.run.given.push_back(key);
    }
}

// A state replaces all settings.
void applyState(CommandLine& line, const Parser& parser, const ReadPictureState& readPicture) {
    const State state = loadState(parser.state, readPicture);
    line.run.inputs.push_back(parser.state);
    line.settings = state.settings;
    for (const SettingInfo& setting : settingsTable()) line.run.given.emplace_back(setting.key);
    line.run.playing = state.playing;
    line.run.speed = state.speed;
    if (parser.scene.empty()) {
        requireScene(state, parser.state);
        line.run.scene = state.scene;
        line.run.sceneHash = state.sceneHash;
    } else if (parser.scene != state.scene) {
        line.settings.camera.name.clear();  // of that scene; where it stood is filled in
    }
}

std::string versionText(const ProgramInfo& program) {
    std::string text = program.name + " " + programVersion();
    const std::string commit = programCommit();
    text.append(" (").append(commit.empty() ? "no commit" : "commit " + commit);
    text.append(", ").append(programBuildType()).append(")\n");
    for (const std::string& library : program.libraries) text.append("  ").append(library + "\n");
    text += "Workarounds that are on where OpenGL is rendered in software:\n";
    for (const gl::WorkaroundInfo& info : gl::workarounds()) {
        text += fmt::format("  {:<18} {} {}\n", info.name, info.what, info.why);
    }
    return text;
}

}  // namespace

bool RunOptions::wantsResults() const {
    const MeasureOptions& m = measure;
    const bool compares =
        !m.referenceFile.empty() &&
        (headless || !m.metrics.empty() || !m.thresholds.empty() || !m.diffFile.empty());
    return compares || (headless && mapReferences > 0) || !outputs.empty() || !statsFile.empty() ||
           !saveViewsFile.empty() || !saveMapsFile.empty() || !saveSceneFile.empty();
}

bool RunOptions::isGiven(const std::string& key) const {
    return std::find(given.begin(), given.end(), key) != given.end();
}

CommandLine parseCommandLine(const std::vector<std::string>& arguments,
                             const ProgramInfo& program) {
    CommandLine line;
    line.run = program.run;
    Parser parser(program);
    // Help and version answer whatever else is on the line.
    for (const std::string& argument : arguments) {
        if (argument == "-h" || argument == "--help") line.reply = parser.app.help();
        if (argument == "--version") line.reply = versionText(program);
        if (!line.reply.empty()) return line;
    }
    parser.parse(withInfoFormat(arguments));

    // Weakest first: configuration file, presets, state, then the line.
    applyConfig(line, parser);
    if (!parser.preset.empty()) applyPresetNamed(line, parser.preset);
    if (!parser.state.empty()) applyState(line, parser, program.readPictureState);
    for (const auto& apply : parser.given) apply(line);
    // A camera chosen by name stands where the scene has it, not where a state's stood.
    if (std::ranges::any_of(parser.settings,
                            [](const auto& given) { return given.setting->key == "camera"; })) {
        line.settings.camera = {};
    }
    applySettings(line, std::move(parser.settings));
    if (!parser.scene.empty()) line.run.scene = parser.scene;
    line.run.sceneGiven = !parser.scene.empty() || !parser.state.empty();
    validate(line.settings);
    return line;
}

}  // namespace mv
