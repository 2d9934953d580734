#pragma once
// How a program talks to the terminal that started it: results on standard output, everything else
// on standard error; progress as a bar on a terminal and as a line now and then elsewhere; and what
// Ctrl+C does.

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "app/common/run_options.h"
#include "megaviews/core/error.h"
#include "megaviews/core/progress.h"

namespace mv {

// Sends spdlog to standard error and, if asked, to a file; colours only on a terminal and never
// with NO_COLOR set. Throws Error(ExitCode::output) if the log file cannot be written.
void startLogging(const RunOptions& options);

// Draws a bar on a terminal; elsewhere logs a line every five seconds, so that short work says
// nothing. Throws Cancelled out of the work once the program was interrupted.
class TerminalProgress {
  public:
    explicit TerminalProgress(bool quiet);
    ~TerminalProgress();
    TerminalProgress(const TerminalProgress&) = delete;
    TerminalProgress& operator=(const TerminalProgress&) = delete;
    Progress callback();

  private:
    void show(std::string_view stage, float fraction01);
    void clear();
    using Clock = std::chrono::steady_clock;
    std::mutex mutex_;
    Clock::time_point start_, lastShown_;
    bool quiet_, terminal_, drawn_ = false;
};

// After this, SIGINT and SIGTERM are only noted; the second one ends the program at once.
void noteInterrupts();
bool interrupted();

// Runs a program's body and turns what it throws into one line on standard error and the exit code
// of that error.
int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv);

}  // namespace mv
