#pragma once
// How the glTF loader speaks: errors that end the loading and warnings that it goes on after, each
// one sentence "file: place in the JSON: reason". Serves the first stage, file -> Scene.

#include <string>
#include <string_view>
#include <vector>

namespace mv {

// Text from a file made fit for a terminal: control characters and bytes that are not UTF-8 are
// replaced by '?', and what is longer than `longest` bytes is cut with an ellipsis.
std::string printable(std::string_view text, std::size_t longest = 120);
// The same in double quotes.
std::string quote(std::string_view text);

class GltfReport {
  public:
    explicit GltfReport(std::string file) : file_(std::move(file)) {}

    // Throws Error(ExitCode::input). `place` may be empty: the file as a whole.
    [[noreturn]] void fail(const std::string& place, const std::string& reason) const;
    // Kept and logged. Not to be called from several threads at once.
    void warn(const std::string& place, const std::string& reason);

    const std::string& file() const { return file_; }
    std::vector<std::string> warnings;

  private:
    std::string sentence(const std::string& place, const std::string& reason) const;
    std::string file_;
};

}  // namespace mv
