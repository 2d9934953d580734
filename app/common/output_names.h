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

// Throws Error(ExitCode::usage) of a file whose ending is none of these. where: who names it.
void requireExtension(const std::string& file, const std::vector<std::string>& allowed,
                      const std::string& where);
// The same check for numbers that are written as JSON; pipes and devices need no ending.
void requireJson(const std::string& file, const std::string& where);

// The absolute path of an input; names of built-in scenes stay as they are.
std::string absoluteName(const std::string& name, const std::filesystem::path& folder = ".");

// The file of one frame. {frame} and {frame:0N} become its number; without them, several frames get
// the number, in four digits, in front of the extension: out.png -> out.0007.png. Throws
// Error(ExitCode::usage) of anything else in braces.
std::string outputName(const std::string& pattern, int frame, int frames);

// The files that --save-maps writes.
std::vector<std::string> mapsFiles(const std::string& file);

// Every file that the run will write, the log and those of its script among them.
std::vector<std::string> outputFiles(const RunOptions& options);
// Every file that the line names and the run reads; what a scene refers to is known once it is
// loaded (Scene::files).
std::vector<std::string> inputFiles(const RunOptions& options, const Settings& settings);

// Throws Error(ExitCode::usage) if two outputs are one file, by whatever names and links, or if an
// output is an input.
void checkApart(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

// Throws Error(ExitCode::output) naming the first file that cannot be written, and why. Leaves
// nothing behind.
void checkWritable(const std::vector<std::string>& files);

// The same check for a folder that files will be put into, which is made if it is not there.
void checkFolder(const std::string& folder);

// Where pictures go that are taken in the window: the user's folder for pictures if there is one
// that may be written to ($XDG_PICTURES_DIR, also as user-dirs.dirs gives it, then ~/Pictures),
// otherwise the current folder. Absolute.
std::filesystem::path picturesFolder();
// The first of prefix-1.png, prefix-2.png, ... in picturesFolder() that does not exist yet, with
// its folder; `extension` has its dot.
std::string freeFileName(const std::string& prefix, const std::string& extension);

}  // namespace mv
