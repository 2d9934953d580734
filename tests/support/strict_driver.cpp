#include "support/strict_driver.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "support/program_interface.h"

#define MV_BIT(NAME) GL_##NAME##_BIT, #NAME

// Stands between the program and the driver: libepoxy calls through pointers, which point here.
// A buffer or texture counts as a whole, whatever range of it is bound.

namespace mv::test {
namespace {

#define MV_HOOKED(X)                                    \
    X(DISPATCHCOMPUTE, DispatchCompute)                 \
    X(DISPATCHCOMPUTEINDIRECT, DispatchComputeIndirect) \
    X(DRAWARRAYS, DrawArrays)                           \
    X(MULTIDRAWELEMENTS, MultiDrawElements)             \
    X(MEMORYBARRIER, MemoryBarrier)                     \
    X(COPYNAMEDBUFFERSUBDATA, CopyNamedBufferSubData)   \
    X(GETNAMEDBUFFERSUBDATA, GetNamedBufferSubData)     \
    X(NAMEDBUFFERSUBDATA, NamedBufferSubData)           \
    X(CLEARNAMEDBUFFERSUBDATA, ClearNamedBufferSubData) \
    X(GETTEXTUREIMAGE, GetTextureImage)                 \
    X(GETTEXTURESUBIMAGE, GetTextureSubImage)           \
    X(TEXTURESUBIMAGE2D, TextureSubImage2D)             \
    X(TEXTURESUBIMAGE3D, TextureSubImage3D)             \
    X(CLEARTEXIMAGE, ClearTexImage)                     \
    X(COPYIMAGESUBDATA, CopyImageSubData)               \
    X(GENERATETEXTUREMIPMAP, GenerateTextureMipmap)     \
    X(NAMEDBUFFERSTORAGE, NamedBufferStorage)           \
    X(TEXTURESTORAGE2D, TextureStorage2D)               \
    X(TEXTURESTORAGE3D, TextureStorage3D)               \
    X(BLITNAMEDFRAMEBUFFER, BlitNamedFramebuffer)       \
    X(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv) \
    X(READPIXELS, ReadPixels)                           \
    X(LINKPROGRAM, LinkProgram)                         \
    X(DELETEPROGRAM, DeleteProgram)                     \
    X(DELETEBUFFERS, DeleteBuffers)                     \
    X(CREATETEXTURES, CreateTextures)                   \
    X(DELETETEXTURES, DeleteTextures)                   \
    X(BINDTEXTUREUNIT, BindTextureUnit)

// The driver's own functions.
struct Driver {
#define MV_MEMBER(TYPE, NAME) PFNGL##TYPE##PROC NAME = nullptr;
    MV_HOOKED(MV_MEMBER)
#undef MV_MEMBER
};
Driver driver;

struct Object {
    GLenum type = GL_NONE;  // GL_BUFFER or GL_TEXTURE
    GLuint id = 0;
    auto operator<=>(const Object&) const = default;
};

// What the last program did to an object, and the kinds of access that no barrier has ordered after
// it.
struct Use {
    GLbitfield unordered = 0;
    std::string by;
};

struct State {
    std::map<Object, Use> written, read;
    std::unordered_map<GLuint, ProgramInterface> programs;
    std::unordered_map<GLuint, GLenum> targets;         // of textures
    std::map<std::pair<GLuint, GLenum>, GLuint> units;  // texture of a unit and target
    std::set<std::string> reports, reported;
};
State state;

std::string labelOf(GLenum type, GLuint id) {
    std::array<char, 128> text{};
    glGetObjectLabel(type, id, text.size(), nullptr, text.data());
    return text[0] ? text.data() : std::to_string(id);
}
std::string nameOf(const Object& o) {
    return (o.type == GL_BUFFER ? "buffer \"" : "texture \"") + labelOf(o.type, o.id) + "\"";
}

void report(std::string text) {
    if (state.reported.insert(text).second) state.reports.insert(std::move(text));
}

// `kind`: the barrier's bit that orders such an access after what shaders did; `bit` its name.
void follows(const std::map<Object, Use>& before, const char* did, const Object& o, GLbitfield kind,
             const char* bit, const std::string& by) {
    const auto found = before.find(o);
    if (o.id == 0 || found == before.end() || !(found->second.unordered & kind)) return;
    report(nameOf(o) + ", " + did + " by program \"" + found->second.by + "\", is then " + by +
           " without " + bit);
}
void sees(const Object& o, GLbitfield kind, const char* bit, const std::string& by) {
    follows(state.written, "written", o, kind, bit, by);
}

// For other compilers to judge: a file for each text that was linked.
void keepTexts(const std::vector<Shader>& shaders) {
    const char* const folder = std::getenv("MEGAVIEWS_SHADER_TEXTS");
    if (!folder) return;
    std::filesystem::create_directories(folder);
    for (const Shader& shader : shaders) {
        const char* const stage = shader.stage == GL_COMPUTE_SHADER  ? ".comp"
                                  : shader.stage == GL_VERTEX_SHADER ? ".vert"
                                                                     : ".frag";
        const std::string name = std::to_string(std::hash<std::string>()(shader.text)) + stage;
        std::ofstream(std::filesystem::path(folder) / name) << shader.text;
    }
}

Object bufferAt(GLenum binding, GLuint index) {
    GLint id = 0;
    glGetIntegeri_v(binding, index, &id);
    return {GL_BUFFER, static_cast<GLuint>(id)};
}

// A buffer texture is the buffer behind it.
Object storageOf(GLuint texture, GLenum target) {
    if (target != GL_TEXTURE_BUFFER) return {GL_TEXTURE, texture};
    GLint buffer = 0;
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_BUFFER_DATA_STORE_BINDING, &buffer);
    return {GL_BUFFER, static_cast<GLuint>(buffer)};
}

Object textureOf(const Sampled& s, GLuint program) {
    GLint unit = 0;
    glGetUniformiv(program, s.location, &unit);
    const auto found = state.units.find({static_cast<GLuint>(unit), s.target});
    if (found == state.units.end() || found->second == 0) return {};
    return storageOf(found->second, s.target);
}

Object imageAt(GLuint unit) {
    GLint texture = 0;
    glGetIntegeri_v(GL_IMAGE_BINDING_NAME, unit, &texture);
    const auto id = static_cast<GLuint>(texture);
    return texture == 0 ? Object{} : storageOf(id, state.targets[id]);
}

GLuint currentProgram() {
    GLint program = 0;
    glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    return static_cast<GLuint>(program);
}

// What a framebuffer is made of; 0, the window's, is nobody's texture.
std::vector<Object> attachmentsOf(GLuint framebuffer) {
    std::vector<Object> out;
    if (framebuffer == 0) return out;
    for (GLenum at = GL_COLOR_ATTACHMENT0; at <= GL_COLOR_ATTACHMENT0 + 8; ++at) {
        const GLenum point = at == GL_COLOR_ATTACHMENT0 + 8 ? GL_DEPTH_ATTACHMENT : at;
        GLint type = 0, id = 0;
        glGetNamedFramebufferAttachmentParameteriv(framebuffer, point,
                                                   GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
        if (type != GL_TEXTURE) continue;
        glGetNamedFramebufferAttachmentParameteriv(framebuffer, point,
                                                   GL_FRAMEBUFFER_ATTACHMENT_OBJECT_NAME, &id);
        out.push_back({GL_TEXTURE, static_cast<GLuint>(id)});
    }
    return out;
}

void useFramebuffer(GLuint framebuffer, const std::string& by) {
    for (const Object& o : attachmentsOf(framebuffer)) {
        sees(o, MV_BIT(FRAMEBUFFER_BARRIER), by);
    }
}

// Loads, stores, fetches: a later store by a shader may come before they are done.
constexpr GLbitfield kShadersWrite =
    GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;

// Before a dispatch, or a draw to `drawn`.
void useProgram(const std::vector<Object>& drawn) {
    const GLuint program = currentProgram();
    if (program == 0) return;
    const ProgramInterface& interface = state.programs[program];
    const std::string label = labelOf(GL_PROGRAM, program);
    const std::string by = "program \"" + label + "\"";
    std::vector<Object> readHere, writtenHere;
    const auto use = [&](const Object& o, const Access& a, GLbitfield kind, const char* bit) {
        sees(o, kind, bit, (a.reads ? "read by " : "written by ") + by);
        if (a.writes) follows(state.read, "read", o, kind, bit, "written by " + by);
        if (o.id && a.reads) readHere.push_back(o);
        if (o.id && a.writes) writtenHere.push_back(o);
    };
    for (const Sampled& s : interface.samplers) {
        const Object o = textureOf(s, program);
        use(o, {}, MV_BIT(TEXTURE_FETCH_BARRIER));
        if (o.id && std::find(drawn.begin(), drawn.end(), o) != drawn.end()) {
            report(nameOf(o) + " is read by " + by + " that draws to it");
        }
    }
    for (const Access& a : interface.uniformBlocks) {
        use(bufferAt(GL_UNIFORM_BUFFER_BINDING, a.binding), {}, MV_BIT(UNIFORM_BARRIER));
    }
    for (const Access& a : interface.blocks) {
        use(bufferAt(GL_SHADER_STORAGE_BUFFER_BINDING, a.binding), a,
            MV_BIT(SHADER_STORAGE_BARRIER));
    }
    for (const Access& a : interface.images) {
        use(imageAt(a.binding), a, MV_BIT(SHADER_IMAGE_ACCESS_BARRIER));
    }
    for (const Object& o : readHere) state.read[o] = {kShadersWrite, label};
    for (const Object& o : writtenHere) state.written[o] = {GL_ALL_BARRIER_BITS, label};
}

GLuint drawFramebuffer() {
    GLint id = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &id);
    return static_cast<GLuint>(id);
}

void useBuffer(GLuint id, const char* by) {
    sees({GL_BUFFER, id}, MV_BIT(BUFFER_UPDATE_BARRIER), by);
}
void useTexture(GLuint id, const char* by) {
    sees({GL_TEXTURE, id}, MV_BIT(TEXTURE_UPDATE_BARRIER), by);
}

// What nobody wrote yet: as a number huge, as a float none.
constexpr GLuint kGarbage = 0xFFC0FFEE;

void fillWithGarbage(GLuint buffer) {
    glClearNamedBufferData(buffer, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &kGarbage);
}

void fillWithGarbage(GLuint texture, GLsizei levels) {
    const std::array<GLuint, 4> integers{kGarbage, kGarbage, kGarbage, kGarbage};
    const std::array<GLfloat, 4> shares{0.3f, 0.6f, 0.9f, 0.4f};
    GLint depth = GL_NONE, red = GL_NONE;
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_DEPTH_TYPE, &depth);
    glGetTextureLevelParameteriv(texture, 0, GL_TEXTURE_RED_TYPE, &red);
    for (GLint level = 0; level < levels; ++level) {
        if (depth != GL_NONE) {
            driver.ClearTexImage(texture, level, GL_DEPTH_COMPONENT, GL_FLOAT, shares.data());
        } else if (red == GL_UNSIGNED_INT || red == GL_INT) {
            driver.ClearTexImage(texture, level, GL_RGBA_INTEGER, static_cast<GLenum>(red),
                                 integers.data());
        } else {
            const void* const values = red == GL_FLOAT ? static_cast<const void*>(integers.data())
                                                       : static_cast<const void*>(shares.data());
            driver.ClearTexImage(texture, level, GL_RGBA, GL_FLOAT, values);
        }
    }
}

// ------------------------------------------------------------- what libepoxy calls instead

void DispatchCompute(GLuint x, GLuint y, GLuint z) {
    useProgram({});
    driver.DispatchCompute(x, y, z);
}
void DispatchComputeIndirect(GLintptr offset) {
    GLint id = 0;
    glGetIntegerv(GL_DISPATCH_INDIRECT_BUFFER_BINDING, &id);
    sees({GL_BUFFER, static_cast<GLuint>(id)}, MV_BIT(COMMAND_BARRIER),
         "used by an indirect dispatch");
    useProgram({});
    driver.DispatchComputeIndirect(offset);
}
void beforeDraw() {
    GLint vertices = 0;
    const GLuint framebuffer = drawFramebuffer();
    useFramebuffer(framebuffer, "used by a draw");
    glGetIntegerv(GL_ELEMENT_ARRAY_BUFFER_BINDING, &vertices);
    sees({GL_BUFFER, static_cast<GLuint>(vertices)}, MV_BIT(ELEMENT_ARRAY_BARRIER),
         "used by a draw");
    GLint slots = 0;
    glGetIntegerv(GL_MAX_VERTEX_ATTRIB_BINDINGS, &slots);
    for (GLint i = 0; i < slots; ++i) {
        glGetIntegeri_v(GL_VERTEX_BINDING_BUFFER, static_cast<GLuint>(i), &vertices);
        sees({GL_BUFFER, static_cast<GLuint>(vertices)}, MV_BIT(VERTEX_ATTRIB_ARRAY_BARRIER),
             "used by a draw");
    }
    useProgram(attachmentsOf(framebuffer));
}
void DrawArrays(GLenum mode, GLint first, GLsizei count) {
    beforeDraw();
    driver.DrawArrays(mode, first, count);
}
void MultiDrawElements(GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                       GLsizei draws) {
    beforeDraw();
    driver.MultiDrawElements(mode, count, type, indices, draws);
}
void MemoryBarrier(GLbitfield bits) {
    for (auto* uses : {&state.written, &state.read}) {
        for (auto& [object, use] : *uses) use.unordered &= ~bits;
        std::erase_if(*uses, [](const auto& use) { return use.second.unordered == 0; });
    }
    driver.MemoryBarrier(bits);
}
void CopyNamedBufferSubData(GLuint from, GLuint to, GLintptr a, GLintptr b, GLsizeiptr bytes) {
    useBuffer(from, "used by a copy");
    useBuffer(to, "used by a copy");
    driver.CopyNamedBufferSubData(from, to, a, b, bytes);
}
void GetNamedBufferSubData(GLuint id, GLintptr offset, GLsizeiptr bytes, void* data) {
    useBuffer(id, "used by a read-back");
    driver.GetNamedBufferSubData(id, offset, bytes, data);
}
void NamedBufferSubData(GLuint id, GLintptr offset, GLsizeiptr bytes, const void* data) {
    useBuffer(id, "used by an upload");
    driver.NamedBufferSubData(id, offset, bytes, data);
}
void ClearNamedBufferSubData(GLuint id, GLenum inside, GLintptr offset, GLsizeiptr bytes,
                             GLenum format, GLenum type, const void* data) {
    useBuffer(id, "used by a fill");
    driver.ClearNamedBufferSubData(id, inside, offset, bytes, format, type, data);
}
void GetTextureImage(GLuint id, GLint level, GLenum format, GLenum type, GLsizei bytes,
                     void* data) {
    useTexture(id, "used by a read-back");
    driver.GetTextureImage(id, level, format, type, bytes, data);
}
void GetTextureSubImage(GLuint id, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                        GLsizei height, GLsizei depth, GLenum format, GLenum type, GLsizei bytes,
                        void* data) {
    useTexture(id, "used by a read-back");
    driver.GetTextureSubImage(id, level, x, y, z, width, height, depth, format, type, bytes, data);
}
void TextureSubImage2D(GLuint id, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                       GLenum format, GLenum type, const void* data) {
    useTexture(id, "used by an upload");
    driver.TextureSubImage2D(id, level, x, y, width, height, format, type, data);
}
void TextureSubImage3D(GLuint id, GLint level, GLint x, GLint y, GLint z, GLsizei width,
                       GLsizei height, GLsizei depth, GLenum format, GLenum type,
                       const void* data) {
    useTexture(id, "used by an upload");
    driver.TextureSubImage3D(id, level, x, y, z, width, height, depth, format, type, data);
}
void ClearTexImage(GLuint id, GLint level, GLenum format, GLenum type, const void* data) {
    useTexture(id, "used by a fill");
    driver.ClearTexImage(id, level, format, type, data);
}
void CopyImageSubData(GLuint from, GLenum fromTarget, GLint a, GLint b, GLint c, GLint d, GLuint to,
                      GLenum toTarget, GLint e, GLint f, GLint g, GLint h, GLsizei width,
                      GLsizei height, GLsizei depth) {
    useTexture(from, "used by a copy");
    useTexture(to, "used by a copy");
    driver.CopyImageSubData(from, fromTarget, a, b, c, d, to, toTarget, e, f, g, h, width, height,
                            depth);
}
void GenerateTextureMipmap(GLuint id) {
    useTexture(id, "used by mipmaps");
    driver.GenerateTextureMipmap(id);
}
void BlitNamedFramebuffer(GLuint from, GLuint to, GLint a, GLint b, GLint c, GLint d, GLint e,
                          GLint f, GLint g, GLint h, GLbitfield mask, GLenum filter) {
    useFramebuffer(from, "used by a blit");
    useFramebuffer(to, "used by a blit");
    driver.BlitNamedFramebuffer(from, to, a, b, c, d, e, f, g, h, mask, filter);
}
void ClearNamedFramebufferfv(GLuint id, GLenum buffer, GLint at, const GLfloat* value) {
    useFramebuffer(id, "used by a clear");
    driver.ClearNamedFramebufferfv(id, buffer, at, value);
}
void ReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                void* data) {
    GLint id = 0;
    glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &id);
    useFramebuffer(static_cast<GLuint>(id), "used by a read-back");
    driver.ReadPixels(x, y, width, height, format, type, data);
}
void NamedBufferStorage(GLuint id, GLsizeiptr bytes, const void* data, GLbitfield flags) {
    driver.NamedBufferStorage(id, bytes, data, flags);
    if (!data) fillWithGarbage(id);
}
void TextureStorage2D(GLuint id, GLsizei levels, GLenum format, GLsizei width, GLsizei height) {
    driver.TextureStorage2D(id, levels, format, width, height);
    fillWithGarbage(id, levels);
}
void TextureStorage3D(GLuint id, GLsizei levels, GLenum format, GLsizei width, GLsizei height,
                      GLsizei depth) {
    driver.TextureStorage3D(id, levels, format, width, height, depth);
    fillWithGarbage(id, levels);
}
void LinkProgram(GLuint id) {
    const std::vector<Shader> shaders = shadersOf(id);
    driver.LinkProgram(id);
    GLint linked = 0;
    glGetProgramiv(id, GL_LINK_STATUS, &linked);
    if (!linked) return;
    state.programs[id] = interfaceOf(id, shaders);
    keepTexts(shaders);
}
void DeleteProgram(GLuint id) {
    state.programs.erase(id);
    driver.DeleteProgram(id);
}
void forget(GLenum type, GLsizei count, const GLuint* ids) {
    for (GLsizei i = 0; i < count; ++i) {
        state.written.erase({type, ids[i]});
        state.read.erase({type, ids[i]});
    }
}
void DeleteBuffers(GLsizei count, const GLuint* ids) {
    forget(GL_BUFFER, count, ids);
    driver.DeleteBuffers(count, ids);
}
void CreateTextures(GLenum target, GLsizei count, GLuint* ids) {
    driver.CreateTextures(target, count, ids);
    for (GLsizei i = 0; i < count; ++i) state.targets[ids[i]] = target;
}
void DeleteTextures(GLsizei count, const GLuint* ids) {
    forget(GL_TEXTURE, count, ids);
    for (auto& [unit, texture] : state.units) {
        for (GLsizei i = 0; i < count; ++i) {
            if (texture == ids[i]) texture = 0;
        }
    }
    driver.DeleteTextures(count, ids);
}
void BindTextureUnit(GLuint unit, GLuint id) {
    driver.BindTextureUnit(unit, id);
    if (id == 0) {
        const auto begin = state.units.lower_bound({unit, 0});
        state.units.erase(begin, state.units.lower_bound({unit + 1, 0}));
        return;
    }
    state.units[{unit, state.targets[id]}] = id;
}

class FailsTests : public ::testing::EmptyTestEventListener {
    // What a suite's set-up did fails its first test.
    void OnTestEnd(const ::testing::TestInfo&) override {
        for (const std::string& text : takeMissingBarriers()) ADD_FAILURE() << text;
    }
};

class Installed : public ::testing::Environment {
    void SetUp() override {
#define MV_INSTALL(TYPE, NAME)                                                        \
    driver.NAME = reinterpret_cast<PFNGL##TYPE##PROC>(eglGetProcAddress("gl" #NAME)); \
    if (driver.NAME) epoxy_gl##NAME = NAME;
        MV_HOOKED(MV_INSTALL)
#undef MV_INSTALL
        ::testing::UnitTest::GetInstance()->listeners().Append(new FailsTests);
    }
};
[[maybe_unused]] const auto* const installed = ::testing::AddGlobalTestEnvironment(new Installed);

}  // namespace

std::vector<std::string> takeMissingBarriers() {
    std::vector<std::string> out(state.reports.begin(), state.reports.end());
    state.reports.clear();
    return out;
}

}  // namespace mv::test
