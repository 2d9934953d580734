#include "app/common/terminal.h"

#include <spdlog/sinks/basic_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "app/common/output_names.h"

namespace mv {
namespace {

constexpr int kInternalError = 70;  // EX_SOFTWARE: none of the documented causes

volatile std::sig_atomic_t interruptCount = 0;

void onInterrupt(int signal) {
    interruptCount = interruptCount + 1;
    if (interruptCount > 1) std::_Exit(128 + signal);
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
        checkWritable({options.logFile});  // spdlog would make folders that are missing
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
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
}

bool interrupted() { return interruptCount > 0; }

int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv) {
    const auto say = [&](const std::string& message) {
        spdlog::default_logger()->flush();
        std::fprintf(stderr, "%s: %s\n", name, message.c_str());
    };
    try {
        return body(argc, argv);
    } catch (const Error& error) {
        say(error.what());
        return static_cast<int>(error.code);
    } catch (const Cancelled&) {
        say("interrupted");
        return static_cast<int>(ExitCode::interrupted);
    } catch (const std::bad_alloc&) {
        say("out of memory; a smaller --scene-depth, --vpls or --view-res needs less");
        return static_cast<int>(ExitCode::impossible);
    } catch (const std::exception& error) {
        say(std::string("internal error, please report it: ") + error.what());
        return kInternalError;
    }
}

}  // namespace mv
