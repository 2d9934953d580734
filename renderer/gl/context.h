#pragma once
// An OpenGL 4.5 core context without a window (EGL device, surfaceless, default display in turn),
// and what any context can do. GLFW makes the window's context in app/; both end in Limits.

#include <cstdint>
#include <memory>
#include <string>

namespace mv::gl {

// Queried once after a context is current; every allocation and dispatch is checked against it.
struct Limits {
    std::string vendor, renderer, version;
    std::string platform;   // "EGL device 0", "EGL surfaceless", "window", ...
    bool software = false;  // llvmpipe, softpipe, swrast: see workarounds.h
    std::int64_t maxStorageBlockBytes = 0;
    std::int64_t maxTextureBufferTexels = 0;
    int maxWorkGroupsX = 0;
    int maxTextureSize = 0;
    int maxArrayLayers = 0;
    int maxStorageBlocks = 0;       // in a compute shader
    int workGroupSize = 64;         // to use for 1-D kernels
    bool groupIsOneVector = false;  // all of its invocations run in step: Workaround::oneVector
};
const Limits& limits();  // of the current context; asserts there is one

// What a context must be.
struct ContextWish {
    std::string device;     // a part of the platform's or the renderer's name; empty: any
    bool hardware = false;  // not rendered in software
};

// Reads Limits, checks the version, and turns on debug output (errors throw in debug builds, are
// logged in release). Call once after making a context current.
// Throws Error(ExitCode::graphics) if it is older than OpenGL 4.5 or not what is wished for.
void initialise(const std::string& platform, const ContextWish& wish = {});

// OpenGL errors that the driver has reported since initialise(); 0 in a correct program. In builds
// with assertions the first one is also thrown as Error(ExitCode::graphics), naming the pass, by
// the next pass, dispatch or draw and at the end of the frame.
std::uint64_t reportedErrors();
void throwReportedError();
inline void throwErrorWhereAsserted() {
#ifndef NDEBUG
    throwReportedError();
#endif
}
// The pass that messages name from here on; returns the one before.
std::string namePass(std::string name);
// While one lives, errors are not reported: the caller asks glGetError and throws its own.
class ErrorsHandledHere {
  public:
    ErrorsHandledHere();
    ~ErrorsHandledHere();
    ErrorsHandledHere(const ErrorsHandledHere&) = delete;
    ErrorsHandledHere& operator=(const ErrorsHandledHere&) = delete;
};

// Owns a headless EGL context and keeps it current on the creating thread.
class HeadlessContext {
  public:
    // The first that is what is wished for, hardware first. Throws Error(ExitCode::graphics)
    // listing every platform tried and why it failed.
    explicit HeadlessContext(const ContextWish& wish = {});
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mv::gl
