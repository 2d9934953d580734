#include "ui/file_browser.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <utility>

#include "megaviews/core/text.h"

namespace mv::ui {
namespace {

namespace fs = std::filesystem;

std::string homeFolder() {
    const char* home = std::getenv("HOME");
    return home && *home ? home : "/";
}

}  // namespace

std::vector<std::string> extensionsOf(Browse purpose) {
    switch (purpose) {
        case Browse::open:
            return {".gltf", ".glb", ".json", ".png", ".exr", ".hdr"};
        case Browse::loadState:
            return {".json", ".png", ".exr"};
        case Browse::loadReference:
            return {".png", ".exr"};
        case Browse::saveState:
            return {".json"};
        case Browse::saveScene:
            return {".glb"};
        case Browse::none:
            break;
    }
    return {};
}

void FileBrowser::open(Browse purpose, const std::string& folder) {
    purpose_ = purpose;
    typed[0] = '\0';
    std::error_code error;
    enter(!folder.empty() && fs::is_directory(folder, error) ? folder
                                                             : fs::current_path(error).string());
    if (!problem_.empty()) enterHome();
}

void FileBrowser::enter(const std::string& folder) {
    std::error_code error;
    const fs::path whole = fs::weakly_canonical(folder, error);
    folder_ = error ? folder : whole.string();
    list();
}

void FileBrowser::enterParent() {
    const fs::path parent = fs::path(folder_).parent_path();
    if (!parent.empty()) enter(parent.string());
}

void FileBrowser::enterHome() { enter(homeFolder()); }

void FileBrowser::setAllFiles(bool all) {
    allFiles_ = all;
    list();
}

void FileBrowser::take(std::size_t entry) {
    chosen_ = entries_.at(entry).name;
    std::snprintf(typed, sizeof typed, "%s", chosen_.c_str());
}

std::string FileBrowser::takeChosen() { return std::exchange(chosen_, {}); }

std::string FileBrowser::completed(const std::string& text) const {
    std::optional<std::string> common;
    for (const Entry& entry : entries_) {
        if (!lowered(entry.name).starts_with(lowered(text))) continue;
        if (!common) {
            common = entry.name;
            continue;
        }
        const auto end =
            std::mismatch(common->begin(), common->end(), entry.name.begin(), entry.name.end());
        common->erase(end.first, common->end());
    }
    return common.value_or("");
}

bool FileBrowser::saves() const {
    return purpose_ == Browse::saveState || purpose_ == Browse::saveScene;
}

// A file that is written gets the extension by which it is known again.
std::string FileBrowser::fileOf(const std::string& text) const {
    const bool fromHome = text == "~" || text.starts_with("~/");
    fs::path path = fromHome ? fs::path(homeFolder() + text.substr(1)) : fs::path(text);
    if (path.is_relative()) path = fs::path(folder_) / path;
    std::error_code error;
    if (saves() && !fs::is_directory(path, error)) {
        const std::string extension = extensionsOf(purpose_).front();
        if (lowered(path.extension().string()) != extension) path += extension;
    }
    return path.string();
}

bool FileBrowser::replaces(const std::string& text) const {
    std::error_code error;
    return saves() && !text.empty() && fs::is_regular_file(fileOf(text), error);
}

void FileBrowser::list() {
    entries_.clear();
    problem_.clear();
    selected = -1;
    std::error_code error;
    const auto known = extensionsOf(purpose_);
    fs::directory_iterator it(folder_, fs::directory_options::skip_permission_denied, error);
    for (; !error && it != fs::directory_iterator(); it.increment(error)) {
        std::error_code ignored;
        Entry entry{it->path().filename().string(), it->is_directory(ignored), 0};
        if (entry.name.empty() || (entry.name[0] == '.' && !allFiles_)) continue;
        if (!entry.folder) {
            const std::string extension = lowered(it->path().extension().string());
            if (!allFiles_ && std::find(known.begin(), known.end(), extension) == known.end()) {
                continue;
            }
            const std::uintmax_t bytes = it->file_size(ignored);
            entry.bytes = ignored ? 0 : static_cast<std::uint64_t>(bytes);
        }
        entries_.push_back(std::move(entry));
    }
    if (error) problem_ = "This folder cannot be read: " + error.message();
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        if (a.folder != b.folder) return a.folder;
        const std::string x = lowered(a.name), y = lowered(b.name);
        return x != y ? x < y : a.name < b.name;
    });
}

std::string FileBrowser::choose(const std::string& text) {
    problem_.clear();
    if (text.empty()) return {};
    const fs::path path = fileOf(text);
    std::error_code error;
    if (fs::is_directory(path, error)) {
        typed[0] = '\0';
        enter(path.string());
        return {};
    }
    if (saves()) {
        if (fs::is_directory(path.parent_path(), error)) return path.string();
        problem_ = "There is no folder " + path.parent_path().string();
        return {};
    }
    if (fs::exists(path, error)) return path.string();
    problem_ = "There is no file " + path.string();
    return {};
}

}  // namespace mv::ui
