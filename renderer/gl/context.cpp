#include "renderer/gl/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <spdlog/spdlog.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "megaviews/core/error.h"
#include "renderer/gl/program.h"
#include "renderer/gl/workarounds.h"
#include "shaders/shared/bindings.glsl"

namespace mv::gl {
namespace {

std::optional<Limits> currentLimits;
// What messages read and write: a driver may send them from threads of its own.
std::mutex messages;
std::uint64_t errorCount = 0;
std::string currentPass;  // of PassScope
std::set<GLuint> toldOf;  // messages of medium severity
std::string firstError;

void GLAPIENTRY onDebugMessage(GLenum source, GLenum type, GLuint id, GLenum severity,
                               GLsizei length, const GLchar* text, const void*) {
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;  // becomes an exception of Program
    const std::lock_guard lock(messages);
    std::string message(text, static_cast<std::size_t>(std::max(length, 0)));
    if (!currentPass.empty()) message = "in pass \"" + currentPass + "\": " + message;
    if (type == GL_DEBUG_TYPE_ERROR) {
        ++errorCount;
        if (firstError.empty()) firstError = message;
        spdlog::error("OpenGL: {}", message);
    } else if (severity == GL_DEBUG_SEVERITY_HIGH) {
        spdlog::warn("OpenGL: {}", message);
    } else if (severity == GL_DEBUG_SEVERITY_MEDIUM && toldOf.insert(id).second) {
        // Such as NVIDIA's 131186, a buffer moved to host memory: once each, not every frame.
        spdlog::warn("OpenGL, {}: {}", id, message);
    }
}

std::string glString(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "";
}

std::int64_t glInt(GLenum name) {
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return value;
}

bool isSoftware(const std::string& renderer) {
    constexpr std::array names = {"llvmpipe", "softpipe", "swrast", "Software", "SwiftShader"};
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return renderer.find(name) != std::string::npos; });
}

const char* eglErrorName(EGLint error) {
    switch (error) {
        case EGL_SUCCESS:
            return "no error reported";
        case EGL_NOT_INITIALIZED:
            return "EGL_NOT_INITIALIZED";
        case EGL_BAD_ACCESS:
            return "EGL_BAD_ACCESS";
        case EGL_BAD_ALLOC:
            return "EGL_BAD_ALLOC";
        case EGL_BAD_ATTRIBUTE:
            return "EGL_BAD_ATTRIBUTE";
        case EGL_BAD_CONFIG:
            return "EGL_BAD_CONFIG";
        case EGL_BAD_CONTEXT:
            return "EGL_BAD_CONTEXT";
        case EGL_BAD_DISPLAY:
            return "EGL_BAD_DISPLAY";
        case EGL_BAD_MATCH:
            return "EGL_BAD_MATCH (is OpenGL 4.5 core supported?)";
        case EGL_BAD_PARAMETER:
            return "EGL_BAD_PARAMETER";
        default:
            return "unknown EGL error";
    }
}

bool hasExtension(const char* list, std::string_view name) {
    std::string_view rest = list ? list : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(' '), rest.size());
        if (rest.substr(0, end) == name) return true;
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return false;
}

// A place that may give a context: a platform, and on the device platform one of its devices.
struct Candidate {
    std::string name;
    EGLenum platform = 0;  // 0: eglGetDisplay(EGL_DEFAULT_DISPLAY)
    void* native = EGL_DEFAULT_DISPLAY;
};

// Hardware devices before software ones, then the platforms without a device.
std::vector<Candidate> candidates(std::string& failures) {
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    std::vector<Candidate> found;
    const bool hasPlatforms = hasExtension(client, "EGL_EXT_platform_base");
    const bool hasDevices = hasExtension(client, "EGL_EXT_device_base") ||
                            (hasExtension(client, "EGL_EXT_device_enumeration") &&
                             hasExtension(client, "EGL_EXT_device_query"));
    if (hasPlatforms && hasDevices && hasExtension(client, "EGL_EXT_platform_device")) {
        EGLint count = 0;
        std::vector<EGLDeviceEXT> devices;
        if (eglQueryDevicesEXT(0, nullptr, &count) && count > 0) {
            devices.resize(static_cast<std::size_t>(count));
            if (!eglQueryDevicesEXT(count, devices.data(), &count)) count = 0;
            devices.resize(static_cast<std::size_t>(count));
        }
        if (devices.empty()) failures += "\n  EGL device: no devices";
        std::vector<Candidate> software;
        for (std::size_t i = 0; i < devices.size(); ++i) {
            const bool soft = hasExtension(eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS),
                                           "EGL_MESA_device_software");
            const std::string name = "EGL device " + std::to_string(i);
            (soft ? software : found).push_back({name, EGL_PLATFORM_DEVICE_EXT, devices[i]});
        }
        found.insert(found.end(), software.begin(), software.end());
    } else {
        failures += "\n  EGL device: EGL_EXT_platform_device is not supported";
    }
    if (hasPlatforms && hasExtension(client, "EGL_MESA_platform_surfaceless")) {
        found.push_back({"EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY});
    } else {
        failures += "\n  EGL surfaceless: EGL_MESA_platform_surfaceless is not supported";
    }
    found.push_back({"EGL default display", 0, EGL_DEFAULT_DISPLAY});
    return found;
}

struct EglContext {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
};

EGLDisplay openDisplay(const Candidate& candidate) {
    if (candidate.platform == 0) return eglGetDisplay(EGL_DEFAULT_DISPLAY);
    return eglGetPlatformDisplayEXT(candidate.platform, candidate.native, nullptr);
}

// Makes the context current, or says why not.
std::string tryCreate(const Candidate& candidate, EglContext& out) {
    const EGLDisplay display = openDisplay(candidate);
    if (display == EGL_NO_DISPLAY) {
        return std::string("no display: ") + eglErrorName(eglGetError());
    }
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor)) {
        return std::string("cannot initialise: ") + eglErrorName(eglGetError());
    }
    const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
    std::string failure;
    EGLConfig config = EGL_NO_CONFIG_KHR;
    if (!hasExtension(extensions, "EGL_KHR_surfaceless_context")) {
        failure = "EGL_KHR_surfaceless_context is not supported";
    } else if (!eglBindAPI(EGL_OPENGL_API)) {
        failure = std::string("desktop OpenGL is not supported: ") + eglErrorName(eglGetError());
    } else if (!hasExtension(extensions, "EGL_KHR_no_config_context") &&
               !hasExtension(extensions, "EGL_MESA_configless_context")) {
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                 EGL_NONE};
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0) {
            failure = "no configuration for desktop OpenGL";
        }
    }
    if (failure.empty()) {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     4,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     5,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
#ifndef NDEBUG
                                     EGL_CONTEXT_OPENGL_DEBUG,
                                     EGL_TRUE,
#endif
                                     EGL_NONE};
        out.display = display;
        out.context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
        if (out.context == EGL_NO_CONTEXT) {
            failure = std::string("no OpenGL 4.5 core context: ") + eglErrorName(eglGetError());
        } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, out.context)) {
            failure = std::string("cannot make current: ") + eglErrorName(eglGetError());
            eglDestroyContext(display, out.context);
        }
    }
    if (!failure.empty()) {
        out = {};
        eglTerminate(display);
    }
    return failure;
}

}  // namespace

const Limits& limits() {
    assert(currentLimits && "gl::initialise was not called");
    if (!currentLimits) throw Error(ExitCode::graphics, "there is no OpenGL context");
    return *currentLimits;
}

void initialise(const std::string& platform, const ContextWish& wish) {
    Limits l;
    l.vendor = glString(GL_VENDOR);
    l.renderer = glString(GL_RENDERER);
    l.version = glString(GL_VERSION);
    l.platform = platform;
    if (epoxy_gl_version() < 45 || !epoxy_is_desktop_gl()) {
        throw Error(ExitCode::graphics, "OpenGL 4.5 is needed; " + platform + " offers \"" +
                                            l.version + "\" on " + l.renderer +
                                            ". A newer driver, or Mesa's llvmpipe, would help");
    }
    l.software = isSoftware(l.renderer);
    if (wish.hardware && l.software) {
        throw Error(ExitCode::graphics,
                    platform + " renders in software (" + l.renderer + "): --require-hardware");
    }
    if (platform.find(wish.device) == std::string::npos &&
        l.renderer.find(wish.device) == std::string::npos) {
        throw Error(ExitCode::graphics,
                    platform + " is " + l.renderer + ": --gl-device asks for " + wish.device);
    }
    l.maxStorageBlockBytes = glInt(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    l.maxTextureBufferTexels = glInt(GL_MAX_TEXTURE_BUFFER_SIZE);
    GLint groups = 0;
    glGetIntegeri_v(GL_MAX_COMPUTE_WORK_GROUP_COUNT, 0, &groups);
    l.maxWorkGroupsX = groups;
    l.maxTextureSize = static_cast<int>(glInt(GL_MAX_TEXTURE_SIZE));
    l.maxArrayLayers = static_cast<int>(glInt(GL_MAX_ARRAY_TEXTURE_LAYERS));
    l.maxStorageBlocks = static_cast<int>(glInt(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS));
    if (l.maxStorageBlocks < static_cast<int>(kStorageBlocks)) {
        throw Error(ExitCode::graphics, "a compute shader needs " + std::to_string(kStorageBlocks) +
                                            " storage blocks; " + l.renderer + " offers " +
                                            std::to_string(l.maxStorageBlocks));
    }
    chooseWorkarounds(l.software);
    l.workGroupSize = isOn(Workaround::smallGroups) ? 8 : 64;
    // llvmpipe's name for itself tells the width of its vectors: eight lanes of 32 bits.
    l.groupIsOneVector = isOn(Workaround::oneVector) && l.workGroupSize == 8 &&
                         l.renderer.find("llvmpipe") != std::string::npos &&
                         l.renderer.find("256 bits") != std::string::npos;
    currentLimits = l;
#ifdef __GLIBC__
    if (isOn(Workaround::keptHeap)) {
        mallopt(M_TRIM_THRESHOLD, 256 << 20);
        mallopt(M_MMAP_THRESHOLD, 16 << 20);
    }
#endif

    {
        const std::lock_guard lock(messages);
        errorCount = 0;
        firstError.clear();
        toldOf.clear();
    }
    glEnable(GL_DEBUG_OUTPUT);
#ifndef NDEBUG
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
#endif
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr,
                          GL_FALSE);
    glDebugMessageCallback(onDebugMessage, nullptr);
    // One state for every pass: texels are tightly packed, cube maps have no seams, depth is 0..1.
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    fillSamplerSlots();
    spdlog::debug("OpenGL {} on {} ({})", l.version, l.renderer, platform);
}

std::uint64_t reportedErrors() {
    const std::lock_guard lock(messages);
    return errorCount;
}

std::string namePass(std::string name) {
    const std::lock_guard lock(messages);
    return std::exchange(currentPass, std::move(name));
}

void throwReportedError() {
    const std::lock_guard lock(messages);
    if (firstError.empty()) return;
    const std::string message = std::exchange(firstError, {});
    throw Error(ExitCode::graphics, "OpenGL error: " + message);
}

ErrorsHandledHere::ErrorsHandledHere() {
    while (glGetError() != GL_NO_ERROR) {
    }
    glDisable(GL_DEBUG_OUTPUT);
}
ErrorsHandledHere::~ErrorsHandledHere() { glEnable(GL_DEBUG_OUTPUT); }

struct HeadlessContext::Impl {
    EglContext egl;
    ~Impl() {
        destroy();
        currentLimits.reset();
    }
    // The display stays initialised: EGL shares it between all contexts of the process.
    void destroy() {
        if (egl.context == EGL_NO_CONTEXT) return;
        forgetPrograms();
        eglMakeCurrent(egl.display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(egl.display, egl.context);
        egl = {};
    }
};

HeadlessContext::HeadlessContext(const ContextWish& wish) : impl_(std::make_unique<Impl>()) {
    // The loader would end the program where there is no EGL at all.
    if (!dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL)) {
        throw Error(ExitCode::graphics,
                    "no OpenGL without a window: libEGL.so.1 is missing (package libegl1)");
    }
    std::string failures;
    for (const Candidate& candidate : candidates(failures)) {
        std::string failure = tryCreate(candidate, impl_->egl);
        if (failure.empty()) {
            try {
                initialise(candidate.name, wish);
                return;
            } catch (const Error& error) {
                if (error.code != ExitCode::graphics) throw;
                failure = error.what();
                impl_->destroy();
            }
        }
        failures += "\n  " + candidate.name + ": " + failure;
    }
    throw Error(ExitCode::graphics,
                "no OpenGL 4.5 core context without a window that will do; tried:" + failures +
                    "\nA graphics driver with EGL, or Mesa's software one (libegl1 and "
                    "libgl1-mesa-dri), would help");
}

HeadlessContext::~HeadlessContext() = default;

}  // namespace mv::gl
