#pragma once
// What the window remembers from one run to the next: recent files, bookmarks of each scene, where
// it stood and how it looked. Kept in $XDG_STATE_HOME/megaviews/viewer.json or
// ~/.local/state/megaviews/viewer.json, never in the working directory.

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "megaviews/settings/settings.h"

namespace mv {

struct Bookmark {  // the file's world units
    std::array<double, 3> position{}, target{}, up{0, 1, 0};
    std::optional<double> fovDeg;  // unset: the camera's own
    bool operator==(const Bookmark&) const = default;
};
// A bookmark is made of settings that withCamera() made (state.h), and goes back into settings.
Bookmark bookmarkOf(const Settings& withCamera);
void useBookmark(Settings& settings, const Bookmark& bookmark);

inline constexpr std::size_t kBookmarks = 9, kRecentFiles = 10, kBookmarkedScenes = 100;

struct SceneBookmarks {
    std::string scene, sceneHash;  // absolute path or builtin:NAME
    std::array<std::optional<Bookmark>, kBookmarks> cameras;
    bool operator==(const SceneBookmarks&) const = default;
};

struct WindowPlace {
    int x = 0, y = 0, width = 0, height = 0;  // screen coordinates
    bool operator==(const WindowPlace&) const = default;
};

struct UserState {
    std::vector<std::string> recent;        // absolute paths or builtin:NAME, newest first
    std::vector<SceneBookmarks> bookmarks;  // last used first
    std::optional<WindowPlace> window;
    std::optional<double> uiScale;  // unset: the display's
    std::string panel;              // the instrument that was open; empty: none
    bool operator==(const UserState&) const = default;

    void noteRecent(const std::string& file);
    // By path, or by content where the file has moved; nullptr if nothing is kept.
    const SceneBookmarks* bookmarksOf(const std::string& scene, const std::string& hash) const;
    SceneBookmarks& bookmarksFor(const std::string& scene, const std::string& hash);
};

// Whether a recent file can still be opened; our own scenes always can.
bool isThere(const std::string& recent);

// Empty where there is no home folder: then nothing is kept.
std::string userStateFile();
// A missing file gives an empty state, and so does a broken one, with a warning.
UserState loadUserState(const std::string& file);
// Reads, changes and writes aside, so that two windows do not forget for each other. A broken file
// is kept beside it as FILE.broken; a state that cannot be written is a warning. Nothing happens
// for an empty name.
void updateUserState(const std::string& file, const std::function<void(UserState&)>& change);

}  // namespace mv
