#include "support/program_interface.h"

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mv::test {
namespace {

struct Qualified {
    bool reads = false, writes = false;
};

// `readonly` and `writeonly` of the blocks and images that a program's text declares.
std::map<std::string, Qualified> qualifiersIn(const std::vector<Shader>& shaders) {
    std::map<std::string, Qualified> out;
    static const std::regex kDeclared(
        R"(\)\s*((?:(?:uniform|coherent|restrict|readonly|writeonly|volatile)\s+)*))"
        R"((?:buffer\s+(\w+)|[iu]?image\w+\s+(\w+)))");
    for (const Shader& shader : shaders) {
        const std::string& text = shader.text;
        for (std::sregex_iterator m(text.begin(), text.end(), kDeclared), end; m != end; ++m) {
            const std::string words = (*m)[1];
            const std::string name = (*m)[2].length() ? (*m)[2] : (*m)[3];
            // Of declarations that the preprocessor chooses from, the one that does more counts.
            Qualified& q = out[name];
            q.reads |= words.find("writeonly") == std::string::npos;
            q.writes |= words.find("readonly") == std::string::npos;
        }
    }
    return out;
}

GLenum targetOf(GLint sampler) {
    switch (sampler) {
        case GL_SAMPLER_BUFFER:
        case GL_INT_SAMPLER_BUFFER:
        case GL_UNSIGNED_INT_SAMPLER_BUFFER:
            return GL_TEXTURE_BUFFER;
        case GL_SAMPLER_2D:
        case GL_INT_SAMPLER_2D:
        case GL_UNSIGNED_INT_SAMPLER_2D:
        case GL_SAMPLER_2D_SHADOW:
            return GL_TEXTURE_2D;
        case GL_SAMPLER_2D_ARRAY:
        case GL_INT_SAMPLER_2D_ARRAY:
        case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
        case GL_SAMPLER_2D_ARRAY_SHADOW:
            return GL_TEXTURE_2D_ARRAY;
        case GL_SAMPLER_CUBE:
            return GL_TEXTURE_CUBE_MAP;
        default:
            return GL_NONE;
    }
}

std::string resourceName(GLuint program, GLenum interface, GLuint index) {
    std::array<char, 256> text{};
    glGetProgramResourceName(program, interface, index, text.size(), nullptr, text.data());
    return text.data();
}
GLint resourceProperty(GLuint program, GLenum interface, GLuint index, GLenum property) {
    GLint value = 0;
    glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &value);
    return value;
}

}  // namespace

std::vector<Shader> shadersOf(GLuint program) {
    std::array<GLuint, 4> ids{};
    GLsizei count = 0;
    glGetAttachedShaders(program, ids.size(), &count, ids.data());
    std::vector<Shader> out;
    for (const GLuint id : std::span(ids).first(static_cast<std::size_t>(count))) {
        GLint stage = 0, length = 0;
        glGetShaderiv(id, GL_SHADER_TYPE, &stage);
        glGetShaderiv(id, GL_SHADER_SOURCE_LENGTH, &length);  // with a zero at its end
        std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetShaderSource(id, length, nullptr, text.data());
        text.pop_back();
        out.push_back({static_cast<GLenum>(stage), std::move(text)});
    }
    return out;
}

ProgramInterface interfaceOf(GLuint program, const std::vector<Shader>& shaders) {
    ProgramInterface out;
    const std::map<std::string, Qualified> qualifiers = qualifiersIn(shaders);
    const auto access = [&](const std::string& name, GLint binding) {
        const auto found = qualifiers.find(name);
        const Qualified q = found == qualifiers.end() ? Qualified{true, true} : found->second;
        return Access{static_cast<GLuint>(binding), q.reads, q.writes};
    };
    const auto count = [&](GLenum interface) {
        GLint n = 0;
        glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &n);
        return static_cast<GLuint>(n);
    };
    for (GLuint i = 0; i < count(GL_SHADER_STORAGE_BLOCK); ++i) {
        out.blocks.push_back(
            access(resourceName(program, GL_SHADER_STORAGE_BLOCK, i),
                   resourceProperty(program, GL_SHADER_STORAGE_BLOCK, i, GL_BUFFER_BINDING)));
    }
    for (GLuint i = 0; i < count(GL_UNIFORM_BLOCK); ++i) {
        out.uniformBlocks.push_back(
            access(resourceName(program, GL_UNIFORM_BLOCK, i),
                   resourceProperty(program, GL_UNIFORM_BLOCK, i, GL_BUFFER_BINDING)));
    }
    for (GLuint i = 0; i < count(GL_UNIFORM); ++i) {
        const GLint type = resourceProperty(program, GL_UNIFORM, i, GL_TYPE);
        const GLint location = resourceProperty(program, GL_UNIFORM, i, GL_LOCATION);
        if (location < 0) continue;
        std::string name = resourceName(program, GL_UNIFORM, i);
        name = name.substr(0, name.find('['));
        const bool isImage =
            type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY;
        const GLint size = resourceProperty(program, GL_UNIFORM, i, GL_ARRAY_SIZE);
        for (GLint k = 0; k < size; ++k) {
            if (isImage) {
                GLint unit = 0;
                glGetUniformiv(program, location + k, &unit);
                out.images.push_back(access(name, unit));
            } else if (targetOf(type) != GL_NONE) {
                out.samplers.push_back({location + k, targetOf(type)});
            }
        }
    }
    return out;
}

}  // namespace mv::test
