#pragma once
// How a program talks to the terminal that started it: results on standard output, everything else
// on standard error; progress as a bar on a terminal and as a line now and then elsewhere; and what
// Ctrl+C does.

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>

#include "app/common/run_options.h"
#include "megaviews/core/error.h"
#include "megaviews/core/progress.h"

namespace mv {

// Sends spdlog to standard error and, if asked, to a file; colours only on a terminal and never
// with NO_COLOR set. The log file has been checked; throws Error(ExitCode::output) if it cannot be
// opened all the same.
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

// After this, SIGINT, SIGTERM and SIGHUP are noted, for the program to end by itself. If it has not
// after a second and a half (a driver is at work, say), or at the second signal, it is ended.
void noteInterrupts();
bool interrupted();

// What an interrupted program keeps even if it has to be ended: while this lives, `keep` is then
// called first, from a thread of its own. What `keep` reads is changed under lock() alone.
class KeptWhenEnded {
  public:
    explicit KeptWhenEnded(std::function<void()> keep);
    ~KeptWhenEnded();
    KeptWhenEnded(const KeptWhenEnded&) = delete;
    KeptWhenEnded& operator=(const KeptWhenEnded&) = delete;
    std::unique_lock<std::mutex> lock();
};

// Runs a program's body and turns what it throws into one line on standard error and the exit code
// of that error. A body that is done has failed all the same, with ExitCode::output, if standard
// output or the log could not be written.
int runProgram(const char* name, int (*body)(int argc, char** argv), int argc, char** argv);

}  // namespace mv
