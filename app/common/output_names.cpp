#include "app/common/output_names.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>

#include "megaviews/core/error.h"

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

bool mayWriteInto(const std::filesystem::path& folder) {
    std::error_code error;
    return folder.is_absolute() && std::filesystem::is_directory(folder, error) &&
           access(folder.c_str(), W_OK | X_OK) == 0;
}

}  // namespace

std::string extensionOf(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

std::string outputName(const std::string& pattern, int frame, int frames) {
    std::string name;
    bool numbered = false;
    for (std::size_t i = 0; i < pattern.size();) {
        const std::size_t end = pattern.find('}', i);
        const std::string field =
            pattern[i] == '{' && end != std::string::npos ? pattern.substr(i, end - i + 1) : "";
        if (field == "{frame}") {
            name += std::to_string(frame);
        } else if (field.size() == 10 && field.starts_with("{frame:0") && field[8] >= '1' &&
                   field[8] <= '9') {
            name += padded(frame, static_cast<std::size_t>(field[8] - '0'));
        } else {
            name += pattern[i++];
            continue;
        }
        numbered = true;
        i += field.size();
    }
    if (!numbered && frames > 1) {
        const std::filesystem::path path(name);
        name = (path.parent_path() / path.stem()).string() + "." + padded(frame, 4) +
               path.extension().string();
    }
    return name;
}

std::vector<std::string> outputFiles(const RunOptions& options) {
    std::vector<std::string> files;
    for (const std::string& pattern : options.outputs) {
        for (int frame = 0; frame < options.frames; ++frame) {
            files.push_back(outputName(pattern, frame, options.frames));
        }
    }
    if (!options.saveMapsFile.empty()) {
        const std::filesystem::path path(options.saveMapsFile);
        const std::string stem = (path.parent_path() / path.stem()).string();
        for (const char* part : {".npy", ".centres.npy", ".views.npy"}) {
            files.push_back(stem + part);
        }
    }
    for (const std::string& file : {options.statsFile, options.saveViewsFile, options.saveSceneFile,
                                    options.saveStateFile, options.measure.diffFile}) {
        if (!file.empty()) files.push_back(file);
    }
    std::set<std::filesystem::path> seen;
    for (const std::string& file : files) {
        if (!seen.insert(std::filesystem::path(file).lexically_normal()).second) {
            throw Error(ExitCode::usage, "'" + file + "' would be written twice");
        }
    }
    return files;
}

void checkWritable(const std::vector<std::string>& files) {
    namespace fs = std::filesystem;
    for (const std::string& file : files) {
        const auto refuse = [&](const std::string& reason) {
            throw Error(ExitCode::output, "'" + file + "' cannot be written: " + reason);
        };
        std::error_code error;
        const fs::path folder =
            fs::path(file).has_parent_path() ? fs::path(file).parent_path() : fs::path(".");
        if (!fs::is_directory(folder, error)) refuse("no folder '" + folder.string() + "'");
        if (fs::is_directory(file, error)) refuse("it is a folder");
        // Pictures are written aside and renamed: it is the folder that must allow it.
        if (access(folder.c_str(), W_OK | X_OK) != 0) refuse("its folder is read-only");
        if (fs::exists(file, error) && access(file.c_str(), W_OK) != 0) refuse("it is read-only");
    }
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
    return fs::current_path();
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
