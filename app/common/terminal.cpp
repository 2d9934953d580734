#include "app/common/terminal.h"

#include <fcntl.h>
#include <semaphore.h>
#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

namespace mv {
namespace {

constexpr int kInternalError = 70;  // EX_SOFTWARE: none of the documented causes

// An interrupted program has this long to end by itself.
constexpr std::chrono::milliseconds kPatience{1500};

volatile std::sig_atomic_t interruptCount = 0;
sem_t interruptNoted;
std::atomic<bool> logFailed = false;

struct Kept {
    std::mutex mutex;
    std::function<void()> keep;
};
Kept& kept() {
    static Kept* const shared = new Kept;  // outlives the thread that ends the program
    return *shared;
}

void onInterrupt(int signal) {
    interruptCount = interruptCount + 1;
    if (interruptCount > 1) std::_Exit(128 + signal);
    sem_post(&interruptNoted);
}

// The thread that ends what does not end by itself.
void awaitInterrupt() {
    while (sem_wait(&interruptNoted) != 0) continue;
    std::this_thread::sleep_for(kPatience);
    const std::lock_guard lock(kept().mutex);
    try {
        if (kept().keep) kept().keep();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
    }
    std::fputs("interrupted\n", stderr);
    std::fflush(stdout);
    std::_Exit(static_cast<int>(ExitCode::interrupted));
}

// A file that is opened where a standard stream was closed would get what is printed.
void fillStandardStreams() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (fcntl(descriptor, F_GETFD) >= 0) continue;
        // The wrong way round, so that reading and writing fail as they would.
        const int mode = descriptor == STDIN_FILENO ? O_WRONLY : O_RDONLY;
        static_cast<void>(open("/dev/null", mode));  // takes the lowest that is free: this one
    }
}

// Writes out whatever is buffered.
void finishOutputs() {
    spdlog::default_logger()->flush();
    if (std::fflush(stdout) != 0) {
        throw Error(ExitCode::output,
                    std::string("standard output cannot be written: ") + std::strerror(errno));
    }
    if (std::ferror(stdout) != 0) {  // an earlier write, whose reason is lost
        throw Error(ExitCode::output, "standard output cannot be written");
    }
    if (logFailed) throw Error(ExitCode::output, "the log could not be written");
}

bool standardErrorIsTerminal() { return isatty(STDERR_FILENO) == 1; }

}  // namespace

void startLogging(const RunOptions& options) {
    const char* noColor = std::getenv("NO_COLOR");
    const bool color = standardErrorIsTerminal() && !(noColor && *noColor);
    auto console = std::make_shared<spdlog::sinks::stderr_color_sink_mt>(
        color ? spdlog::color_mode::always : spdlog::color_mode::never);
    console->set_pattern("%^%l%$: %v");
    constexpr spdlog::level::level_enum kLevels[] = {spdlog::level::debug, spdlog::level::info,
                                                     spdlog::level::warn, spdlog::level::err,
                                                     spdlog::level::off};
    console->set_level(kLevels[static_cast<int>(options.logLevel)]);
    std::vector<spdlog::sink_ptr> sinks = {console};
    if (!options.logFile.empty()) {
        // The folder was checked earlier: the logger would make missing ones.
        try {
            auto file = std::make_shared<spdlog::sinks::basic_file_sink_mt>(options.logFile, true);
            file->set_pattern("%Y-%m-%d %H:%M:%S.%e %l: %v");
            sinks.push_back(std::move(file));
        } catch (const spdlog::spdlog_ex&) {
            throw Error(ExitCode::output,
                        "--log-file: '" + options.logFile + "' cannot be written");
        }
    }
    auto logger = std::make_shared<spdlog::logger>("", sinks.begin(), sinks.end());
    logger->set_level(spdlog::level::debug);
    logger->flush_on(spdlog::level::warn);
    logger->set_error_handler([](const std::string& reason) {
        if (!logFailed.exchange(true)) std::fprintf(stderr, "log: %s\n", reason.c_str());
    });
    spdlog::set_default_logger(std::move(logger));
}

TerminalProgress::TerminalProgress(bool quiet)
    : start_(Clock::now()),
      lastShown_(start_),
      quiet_(quiet),
      terminal_(standardErrorIsTerminal()) {}

TerminalProgress::~TerminalProgress() { clear(); }

void TerminalProgress::clear() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

Progress TerminalProgress::callback() {
    return [this](std::string_view stage, float fraction01) { show(stage, fraction01); };
}

void TerminalProgress::show(std::string_view stage, float fraction01) {
    if (interrupted()) throw Cancelled();
    if (quiet_) return;
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    const auto pause = terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(5);
    if (now - lastShown_ < pause) return;
    lastShown_ = now;
    const int percent = static_cast<int>(100 * std::clamp(fraction01, 0.0f, 1.0f));
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    if (!terminal_) {
        spdlog::info("{}: {} %, {:.0f} s", stage, percent, elapsed);
        return;
    }
    constexpr int kWidth = 24;
    char bar[kWidth + 1] = {};
    for (int i = 0; i < kWidth; ++i) bar[i] = i * 100 < percent * kWidth ? '#' : '.';
    std::fprintf(stderr, "\r\033[K[%s] %3d %% %.*s, %.0f s", bar, percent,
                 static_cast<int>(stage.size()), stage.data(), elapsed);
    drawn_ = true;
}

void noteInterrupts() {
    sem_init(&interruptNoted, 0, 0);
    std::thread(awaitInterrupt).detach();
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
}

KeptWhenEnded::KeptWhenEnded(std::function<void()> keep) {
    const std::lock_guard guard(kept().mutex);
    kept().keep = std::move(keep);
}

KeptWhenEnded::~KeptWhenEnded() {
    const std::lock_guard guard(kept().mutex);
    kept().keep = nullptr;
}

std::unique_lock<std::mutex> KeptWhenEnded::lock() { return std::unique_lock(kept().mutex); }

bool interrupted() { return interruptCount > 0; }

int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv) {
    const auto say = [&](const std::string& message) {
        spdlog::default_logger()->flush();
        std::fprintf(stderr, "%s: %s\n", name, message.c_str());
    };
    fillStandardStreams();
    std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves costs no other result
    std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is one that finds no room
    try {
        const int code = body(argc, argv);
        if (code == static_cast<int>(ExitCode::ok)) finishOutputs();
        return code;
    } catch (const Cancelled&) {
        say("interrupted");
        return static_cast<int>(ExitCode::interrupted);
    } catch (const std::exception& thrown) {
        try {
            const Error error = thrownError();
            say(error.what());
            return static_cast<int>(error.code);
        } catch (...) {
            say(std::string("internal error, please report it: ") + thrown.what());
            return kInternalError;
        }
    }
}

}  // namespace mv
