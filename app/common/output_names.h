#pragma once
// Where results go: names of numbered pictures, where the window puts its own, and the check,
// before anything is rendered, that every file can be written.

#include <filesystem>
#include <string>
#include <vector>

#include "app/common/run_options.h"

namespace mv {

// With its dot and in lower case: ".png".
std::string extensionOf(const std::string& file);

// The file of one frame. {frame} and {frame:0N} become its number; without them, several frames get
// the number, in four digits, in front of the extension: out.png -> out.0007.png.
std::string outputName(const std::string& pattern, int frame, int frames);

// Every file that the run will write. Throws Error(ExitCode::usage) if two would be the same.
std::vector<std::string> outputFiles(const RunOptions& options);

// Throws Error(ExitCode::output) naming the first file whose folder is missing or may not be
// written to, or which is itself a folder. Leaves nothing behind.
void checkWritable(const std::vector<std::string>& files);

// Where pictures go that are taken in the window: the user's folder for pictures if there is one
// that may be written to ($XDG_PICTURES_DIR, also as user-dirs.dirs gives it, then ~/Pictures),
// otherwise the current folder. Absolute.
std::filesystem::path picturesFolder();
// The first of prefix-1.png, prefix-2.png, ... in picturesFolder() that does not exist yet, with
// its folder; `extension` has its dot.
std::string freeFileName(const std::string& prefix, const std::string& extension);

}  // namespace mv
