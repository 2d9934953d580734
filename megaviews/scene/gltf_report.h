#pragma once
// How the glTF loader speaks: errors that end the loading and warnings that it goes on after, each
// one sentence "file: place in the JSON: reason". Serves the first stage, file -> Scene.

#include <string>
#include <vector>

#include "megaviews/core/text.h"

namespace mv {

class GltfReport {
  public:
    explicit GltfReport(std::string file, bool logs = true) : file_(std::move(file)), logs_(logs) {}

    // Throws Error(ExitCode::input). `place` may be empty: the file as a whole.
    [[noreturn]] void fail(const std::string& place, const std::string& reason) const;
    // Kept, and logged unless that was done before. Not to be called from several threads at once.
    void warn(const std::string& place, const std::string& reason);

    const std::string& file() const { return file_; }
    std::vector<std::string> warnings;

  private:
    std::string sentence(const std::string& place, const std::string& reason) const;
    std::string file_;
    bool logs_;
};

}  // namespace mv
