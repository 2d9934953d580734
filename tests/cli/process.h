#pragma once
// Runs the built programs as a user would: in a folder of their own that is also their home,
// without a display, with caches, configuration and state kept away from the user's.

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace mv::test {

struct ProcessResult {
    int code = 0;  // exit code; 128 + signal if one ended it
    std::string out, err;
    std::string errLine() const;  // standard error without its log lines of level info or below
};

class Sandbox {
  public:
    Sandbox();
    ~Sandbox();
    Sandbox(const Sandbox&) = delete;
    Sandbox& operator=(const Sandbox&) = delete;

    std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    std::string text(const std::string& name) const;
    void write(const std::string& name, const std::string& text) const;

    // "megaviews", "megaviews-bench" or the path of another program; waits for it, at most two
    // minutes. `environment` changes variables; an empty value removes one.
    ProcessResult run(const std::string& program, const std::vector<std::string>& arguments,
                      const std::map<std::string, std::string>& environment = {}) const;
    ProcessResult megaviews(const std::vector<std::string>& arguments,
                            const std::map<std::string, std::string>& environment = {}) const {
        return run("megaviews", arguments, environment);
    }
    // Started, not waited for.
    pid_t start(const std::string& program, const std::vector<std::string>& arguments,
                const std::map<std::string, std::string>& environment = {}) const;
    ProcessResult wait(pid_t pid) const;

  private:
    std::filesystem::path folder_;
};

// A picture that takes well under a second once shaders are cached.
std::vector<std::string> smallPicture(std::vector<std::string> more = {});

// The values of a picture, row by row; none if it cannot be read.
std::vector<float> pixelsOf(const std::filesystem::path& file);

}  // namespace mv::test

// Tests that need OpenGL skip, with the program's own reason, where there is none.
#define MV_SKIP_WITHOUT_GL(result) \
    if ((result).code == 4) GTEST_SKIP() << (result).err
