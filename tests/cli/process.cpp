#include "cli/process.h"

#include <OpenImageIO/imageio.h>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace mv::test {
namespace fs = std::filesystem;

namespace {

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

}  // namespace

std::string ProcessResult::errLine() const {
    std::istringstream lines(err);
    std::string kept;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("info: ") || line.starts_with("debug: ")) continue;
        kept += kept.empty() ? line : "\n" + line;
    }
    return kept;
}

Sandbox::Sandbox() {
    std::string pattern = (fs::temp_directory_path() / "megaviews-cli-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    folder_ = pattern;
    fs::create_directory(folder_ / "config");
    fs::create_directory(folder_ / "cache");
}

Sandbox::~Sandbox() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

std::string Sandbox::text(const std::string& name) const { return contents(folder_ / name); }

void Sandbox::write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
}

pid_t Sandbox::start(const std::string& program, const std::vector<std::string>& arguments,
                     const std::map<std::string, std::string>& environment) const {
    std::map<std::string, std::string> variables = {
        {"DISPLAY", ""},
        {"WAYLAND_DISPLAY", ""},
        {"NO_COLOR", "1"},
        {"HOME", folder_.string()},
        {"XDG_CONFIG_HOME", (folder_ / "config").string()},
        {"XDG_STATE_HOME", (folder_ / "state").string()},
        {"XDG_PICTURES_DIR", ""},
        {"XDG_CACHE_HOME", (folder_ / "cache").string()},
        // Compiled shaders are worth keeping from test to test.
        {"MESA_SHADER_CACHE_DIR", MEGAVIEWS_BINARY_DIR "/test_shader_cache"}};
    for (const auto& [name, value] : environment) variables[name] = value;

    const std::string path = program.front() == '/' ? program : MEGAVIEWS_BINARY_DIR "/" + program;
    const pid_t pid = fork();
    if (pid < 0) throw std::runtime_error("fork failed");
    if (pid > 0) return pid;
    setpgid(0, 0);  // what it starts ends with it

    const auto redirect = [&](const char* name, int descriptor) {
        const int file =
            open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
        dup2(file, descriptor);
    };
    redirect("stdout", STDOUT_FILENO);
    redirect("stderr", STDERR_FILENO);
    for (const auto& [name, value] : variables) {
        if (value.empty()) {
            unsetenv(name.c_str());
        } else {
            setenv(name.c_str(), value.c_str(), 1);
        }
    }
    std::vector<char*> argv = {const_cast<char*>(path.c_str())};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    if (chdir(folder_.c_str()) == 0) execv(path.c_str(), argv.data());
    _exit(127);
}

ProcessResult Sandbox::wait(pid_t pid) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > deadline) kill(-pid, SIGKILL);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ProcessResult result;
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.out = text("stdout");
    result.err = text("stderr");
    return result;
}

ProcessResult Sandbox::run(const std::string& program, const std::vector<std::string>& arguments,
                           const std::map<std::string, std::string>& environment) const {
    return wait(start(program, arguments, environment));
}

std::vector<std::string> smallPicture(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"--headless",
                                          "--no-cache",
                                          "builtin:cornell",
                                          "--scene-depth",
                                          "6",
                                          "--view-depth",
                                          "6",
                                          "--vpls",
                                          "256",
                                          "--resolution",
                                          "96x54",
                                          "--gather-samples",
                                          "8"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

std::vector<float> pixelsOf(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) return {};
    const OIIO::ImageSpec& spec = input->spec();
    std::vector<float> values(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, values.data());
    return values;
}

}  // namespace mv::test
