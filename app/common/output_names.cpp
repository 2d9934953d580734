#include "app/common/output_names.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>

#include "megaviews/core/error.h"
#include "megaviews/core/output_file.h"
#include "megaviews/core/text.h"
#include "megaviews/io/save_maps.h"

namespace mv {
namespace {

std::string padded(int number, std::size_t digits) {
    std::string text = std::to_string(number);
    if (text.size() < digits) text.insert(0, digits - text.size(), '0');
    return text;
}

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

// What xdg-user-dirs writes: XDG_PICTURES_DIR="$HOME/Pictures" or an absolute path.
std::string picturesOfUserDirs(const std::string& home) {
    const std::string config = variable("XDG_CONFIG_HOME");
    std::ifstream file((config.empty() ? home + "/.config" : config) + "/user-dirs.dirs");
    constexpr std::string_view kKey = "XDG_PICTURES_DIR=\"", kHome = "$HOME";
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with(kKey) || !line.ends_with('"') || line.size() == kKey.size()) continue;
        const std::string value = line.substr(kKey.size(), line.size() - kKey.size() - 1);
        return value.starts_with(kHome) ? home + value.substr(kHome.size()) : value;
    }
    return {};
}

// Equal for all names of one regular file, whether it exists yet or not; empty for devices and
// pipes, which may be named twice.
std::string identityOf(const std::string& file) {
    const std::filesystem::path path = throughLinks(file);
    struct stat status {};
    const auto place = [&] {
        return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
    };
    if (::stat(path.c_str(), &status) == 0) {
        return S_ISREG(status.st_mode) || S_ISDIR(status.st_mode) ? place() : std::string();
    }
    const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
    if (::stat(parent.c_str(), &status) != 0) return path.lexically_normal().string();
    return place() + "/" + path.filename().string();
}

bool mayWriteInto(const std::filesystem::path& folder) {
    std::error_code error;
    return folder.is_absolute() && std::filesystem::is_directory(folder, error) &&
           access(folder.c_str(), W_OK | X_OK) == 0;
}

}  // namespace

std::string extensionOf(const std::string& file) {
    return lowered(std::filesystem::path(file).extension().string());
}

void requireExtension(const std::string& file, const std::vector<std::string>& allowed,
                      const std::string& where) {
    const std::string extension = extensionOf(file);
    if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return;
    throw Error(ExitCode::usage, where + ": '" + file + "' must end in " + joined(allowed, " or ") +
                                     ": it chooses the format");
}

void requireJson(const std::string& file, const std::string& where) {
    if (!extensionOf(file).empty()) requireExtension(file, {".json"}, where);
}

std::string absoluteName(const std::string& name, const std::filesystem::path& folder) {
    if (name.empty() || name.starts_with("builtin:")) return name;
    std::error_code error;
    const std::filesystem::path path = std::filesystem::absolute(folder / name, error);
    return error ? name : path.lexically_normal().string();
}

std::string outputName(const std::string& pattern, int frame, int frames) {
    std::string name;
    bool numbered = false;
    for (std::size_t i = 0; i < pattern.size();) {
        const std::size_t end = pattern.find('}', i);
        if (pattern[i] != '{' || end == std::string::npos) {
            name += pattern[i++];
            continue;
        }
        const std::string field = pattern.substr(i, end - i + 1);
        if (field == "{frame}") {
            name += std::to_string(frame);
        } else if (field.size() == 10 && field.starts_with("{frame:0") && field[8] >= '1' &&
                   field[8] <= '9') {
            name += padded(frame, static_cast<std::size_t>(field[8] - '0'));
        } else {
            throw Error(ExitCode::usage, "--output: '" + pattern + "': " + field +
                                             " is not known; {frame} and {frame:04} are");
        }
        numbered = true;
        i = end + 1;
    }
    if (!numbered && frames > 1) {
        const std::filesystem::path path(name);
        name = (path.parent_path() / path.stem()).string() + "." + padded(frame, 4) +
               path.extension().string();
    }
    return name;
}

std::vector<std::string> mapsFiles(const std::string& file) {
    return {file, besideNpy(file, "centres").string(), besideNpy(file, "views").string()};
}

std::vector<std::string> outputFiles(const RunOptions& options) {
    std::vector<std::string> files;
    for (const std::string& pattern : options.outputs) {
        for (int frame = 0; frame < options.frames; ++frame) {
            files.push_back(outputName(pattern, frame, options.frames));
        }
    }
    if (!options.saveMapsFile.empty()) {
        for (std::string& file : mapsFiles(options.saveMapsFile)) files.push_back(std::move(file));
    }
    for (const std::string& file : {options.statsFile, options.saveViewsFile, options.saveSceneFile,
                                    options.saveStateFile, options.measure.diffFile}) {
        if (!file.empty()) files.push_back(file);
    }
    if (!options.logFile.empty()) files.push_back(options.logFile);
    for (std::string& file : script::outputFiles(options.actions)) files.push_back(std::move(file));
    return files;
}

std::vector<std::string> inputFiles(const RunOptions& options, const Settings& settings) {
    std::vector<std::string> files = options.inputs;
    for (const std::string& file :
         {options.scene, options.measure.referenceFile, settings.views.file,
          environmentFile(settings.scene.environment)}) {
        if (!file.empty() && !file.starts_with("builtin:")) files.push_back(file);
    }
    for (std::string& file : script::inputFiles(options.actions)) files.push_back(std::move(file));
    return files;
}

void checkApart(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs) {
    std::set<std::string> read, written;
    for (const std::string& file : inputs) read.insert(identityOf(file));
    for (const std::string& file : outputs) {
        const std::string identity = identityOf(file);
        if (identity.empty()) continue;
        if (read.contains(identity)) {
            throw Error(ExitCode::usage,
                        "'" + file + "' is read by this run and would be overwritten");
        }
        if (!written.insert(identity).second) {
            throw Error(ExitCode::usage, "'" + file + "' would be written twice");
        }
    }
}

void checkWritable(const std::vector<std::string>& files) {
    for (const std::string& file : files) OutputFile::check(file);
}

void checkFolder(const std::string& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        throw Error(ExitCode::output, "'" + folder + "' cannot be made: " + error.message());
    }
    OutputFile::check(std::filesystem::path(folder) / "reference.npy");
}

std::filesystem::path picturesFolder() {
    namespace fs = std::filesystem;
    const std::string home = variable("HOME");
    if (const std::string folder = variable("XDG_PICTURES_DIR"); mayWriteInto(folder))
        return folder;
    if (fs::path(home).is_absolute()) {
        // The home folder itself in its place means that there is none.
        const fs::path named = fs::path(picturesOfUserDirs(home)).lexically_normal();
        const bool none =
            (named / "").lexically_normal() == (fs::path(home) / "").lexically_normal();
        if (!none && mayWriteInto(named)) return named;
        if (fs::path folder = fs::path(home) / "Pictures"; mayWriteInto(folder)) return folder;
    }
    std::error_code gone;
    const fs::path here = fs::current_path(gone);
    return gone ? "." : here;
}

std::string freeFileName(const std::string& prefix, const std::string& extension) {
    const std::filesystem::path folder = picturesFolder();
    for (int i = 1;; ++i) {
        std::filesystem::path file = folder / (prefix + "-" + std::to_string(i) + extension);
        std::error_code unreadable;
        if (!std::filesystem::exists(file, unreadable)) return file.string();
    }
}

}  // namespace mv
