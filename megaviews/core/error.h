#pragma once
// Errors from outside (file, driver, memory, usage) and the exit codes they become.
// A broken invariant of our own is an assert; an expected miss is a std::optional.

#include <new>
#include <stdexcept>
#include <string>

namespace mv {

enum class ExitCode : int {
    ok = 0,
    checkFailed = 1,  // rendered, but NaN or infinity was found, or a threshold missed
    usage = 2,        // unknown flag, bad value, bad configuration
    input = 3,        // missing, unreadable, malformed, or needs an unsupported extension
    graphics = 4,     // no OpenGL 4.5 context, or a shader does not compile
    output = 5,       // cannot be written
    impossible = 6,   // memory budget or device limit; the message says what would fit
    interrupted = 130,
};

// One clear sentence: what, which file, where in it, and what would help.
class Error : public std::runtime_error {
  public:
    Error(ExitCode exitCode, const std::string& message)
        : std::runtime_error(message), code(exitCode) {}
    ExitCode code;
};

// In a catch clause: what was thrown, memory that ran out included. Rethrows all else.
inline Error thrownError() {
    try {
        throw;
    } catch (const Error& error) {
        return error;
    } catch (const std::bad_alloc&) {
        return Error(ExitCode::impossible,
                     "out of memory; a smaller --scene-depth, --vpls or --view-res needs less");
    }
}

// Thrown by a Progress callback to abandon long work; never shown as an error.
class Cancelled : public std::exception {
  public:
    const char* what() const noexcept override { return "cancelled"; }
};

}  // namespace mv
