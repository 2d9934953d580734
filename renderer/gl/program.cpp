#include "renderer/gl/program.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <glm/gtc/type_ptr.hpp>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <unordered_map>

#include "megaviews/core/error.h"
#include "megaviews/core/input_file.h"
#include "megaviews/core/text.h"
#include "renderer/gl/buffer.h"
#include "renderer/gl/context.h"
#include "renderer/gl/texture.h"
#include "renderer/gl/vertex_array.h"

namespace mv::gl {

// In the generated file that holds every shader.
std::span<const std::pair<std::string_view, std::string_view>> embeddedShaders();

// A shader with its includes put in place. Each file has a number, its index in `files`, which
// #line passes to the compiler and which the compiler's messages bear.
struct Program::Source {
    std::string text;
    std::vector<std::string> files;
};

namespace {

using Source = Program::Source;

// Where shaders are read from instead of the executable; empty: nowhere.
std::string& chosenFolder() {
    static std::string folder;
    return folder;
}
std::string shaderFolder() {
    const char* folder = std::getenv("MEGAVIEWS_SHADER_DIR");
    return folder && *folder ? folder : chosenFolder();
}

// Does somebody change shaders while the program runs? They may then leave uniforms out.
bool& shadersAreEdited() {
    static bool edited = false;
    return edited;
}

std::set<Program*>& livePrograms() {
    static std::set<Program*> programs;
    return programs;
}

std::optional<std::string> readShader(const std::string& name) {
    if (const std::string folder = shaderFolder(); !folder.empty()) {
        const Resource file = readRegularFile(folder + "/" + name);
        if (!file.ok()) return std::nullopt;
        return std::string(file.bytes.begin(), file.bytes.end());
    }
    for (const auto& [embedded, text] : embeddedShaders()) {
        if (!embedded.empty() && embedded == name) return std::string(text);
    }
    return std::nullopt;
}

// The next line of `rest`, which loses it; none is left of an empty one. Not std::getline(), which
// takes a lack of memory for the end of the text.
std::string_view nextLine(std::string_view& rest) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    return line;
}

// The file that an include line names, empty if it is not an include.
// Lines that are for C++ alone (<...> or a .h file) give "-". A name may stand for the file: that
// of a define.
std::string includedFile(std::string_view line, const Defines& defines) {
    line = trimmed(line);
    if (line.empty() || line.front() != '#') return {};
    line = trimmed(line.substr(1));
    if (line.substr(0, 7) != "include") return {};
    line = trimmed(line.substr(7));
    for (const auto& [name, value] : defines) {
        if (line == name) line = value;
    }
    if (line.empty() || line.front() != '"') return "-";
    line.remove_prefix(1);
    std::string_view name = line.substr(0, line.find('"'));
    if (name.ends_with(".h")) return "-";
    constexpr std::string_view kRoot = "shaders/";
    if (name.starts_with(kRoot)) name.remove_prefix(kRoot.size());
    return std::string(name);
}

void expand(const std::string& file, const std::string& includedFrom, const Defines& defines,
            std::vector<std::string>& open, Source& out) {
    if (std::find(open.begin(), open.end(), file) != open.end()) {
        // A file that includes itself ends natively by its guard, so this text is never reached.
        return;
    }
    const std::optional<std::string> text = readShader(file);
    if (!text) {
        const std::string folder = shaderFolder();
        throw Error(ExitCode::graphics,
                    "shader file \"" + file + "\" does not exist" +
                        (includedFrom.empty() ? "" : ", included from " + includedFrom) +
                        (folder.empty() ? "" : " (looked in " + folder + ")"));
    }
    const auto known = std::find(out.files.begin(), out.files.end(), file);
    const auto number = std::to_string(known - out.files.begin());
    if (known == out.files.end()) out.files.push_back(file);
    open.push_back(file);
    out.text += "#line 1 " + number + "\n";
    int lineNumber = 0;
    for (std::string_view rest = *text; !rest.empty();) {
        const std::string_view line = nextLine(rest);
        ++lineNumber;
        const std::string included = includedFile(line, defines);
        if (included.empty()) {
            out.text.append(line) += "\n";
        } else if (included == "-") {
            out.text += "\n";
        } else {
            expand(included, file + ":" + std::to_string(lineNumber), defines, open, out);
            out.text += "#line " + std::to_string(lineNumber + 1) + " " + number + "\n";
        }
    }
    open.pop_back();
}

Source resolve(const std::string& file, const Defines& defines) {
    Source source;
    std::vector<std::string> open;
    expand(file, "", defines, open, source);
    return source;
}

// Messages start "S:L(C):" (Mesa), "S(L) :" (NVIDIA) or "ERROR: S:L:" (others): S becomes a name.
// (No <regex>: it takes longer to compile than all the rest of this folder.)
std::string withFileNames(const std::string& log, const std::vector<std::string>& files) {
    std::string out;
    for (std::string_view rest = log; !rest.empty();) {
        std::string line(nextLine(rest));
        const std::size_t place = line.starts_with("ERROR: ")     ? 7
                                  : line.starts_with("WARNING: ") ? 9
                                                                  : 0;
        unsigned file = 0, number = 0;
        int length = 0;
        char mark[2];
        if (std::sscanf(line.c_str() + place, "%u%1[:(]%u%n", &file, mark, &number, &length) == 3 &&
            file < files.size()) {
            const std::size_t end = place + static_cast<std::size_t>(length);
            line.replace(place, end + (mark[0] == '(') - place,
                         files[file] + ":" + std::to_string(number));
        }
        out += line + "\n";
    }
    return out;
}

GLenum stageOf(const std::string& file) {
    if (file.ends_with(".comp")) return GL_COMPUTE_SHADER;
    if (file.ends_with(".vert")) return GL_VERTEX_SHADER;
    if (file.ends_with(".frag")) return GL_FRAGMENT_SHADER;
    throw Error(ExitCode::graphics, "shader file \"" + file + "\" is no .comp, .vert or .frag");
}

template <typename Get, typename GetLog>
std::string infoLog(GLuint object, Get get, GetLog getLog) {
    GLint length = 0;
    get(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    GLsizei written = 0;
    getLog(object, length, &written, log.data());
    log.resize(static_cast<std::size_t>(std::max(written, 0)));
    return log;
}

GLuint compile(const std::string& label, const std::string& file, const Source& source,
               const Defines& defines) {
    std::string text = "#version 450 core\n";
    for (const auto& [name, value] : defines) text += "#define " + name + " " + value + "\n";
    text += source.text;
    const GLuint shader = glCreateShader(stageOf(file));
    const char* data = text.c_str();
    glShaderSource(shader, 1, &data, nullptr);
    glCompileShader(shader);
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) {
        const std::string log = infoLog(
            shader, [](auto... a) { glGetShaderiv(a...); },
            [](auto... a) { glGetShaderInfoLog(a...); });
        glDeleteShader(shader);
        throw Error(ExitCode::graphics, "shader \"" + label + "\" does not compile:\n" +
                                            withFileNames(log, source.files));
    }
    return shader;
}

std::size_t hashOf(std::size_t before, const Source& source) {
    return before * 31 + std::hash<std::string>{}(source.text);
}

bool isWordPart(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// Does any of the files declare the uniform, whatever the defines leave of it?
bool declares(const std::vector<std::string>& files, const Defines& defines,
              std::string_view name) {
    for (const std::string& file : files) {
        const std::string text = resolve(file, defines).text;
        for (std::string_view rest = text; !rest.empty();) {
            const std::string_view line = nextLine(rest);
            if (!trimmed(line).starts_with("uniform ")) continue;
            for (std::size_t at = line.find(name); at != std::string::npos;
                 at = line.find(name, at + 1)) {
                const std::size_t end = at + name.size();
                if (!isWordPart(line[at - 1]) && (end == line.size() || !isWordPart(line[end])))
                    return true;
            }
        }
    }
    return false;
}

}  // namespace

std::string shaderSource(const std::string& file) { return resolve(file, {}).text; }

struct Program::Compiled {
    GLuint id = 0;
    glm::ivec3 groupSize{1};
    std::size_t textHash = 0;
    std::unordered_map<std::string, GLint> locations;
    ~Compiled() { glDeleteProgram(id); }
};

namespace {

// By files, their text and the defines; never destroyed, as the context may be gone by then.
auto& compiledPrograms() {
    static auto& programs = *new std::map<std::string, std::shared_ptr<Program::Compiled>>;
    return programs;
}

}  // namespace

void forgetPrograms() { compiledPrograms().clear(); }

constexpr std::string_view kWorkgroupSize = "MV_WORKGROUP_SIZE";  // of compute shaders

Program::Program(std::string label, const std::vector<std::string>& files, const Defines& defines)
    : label_(std::move(label)), files_(files), defines_(defines) {
    const auto given = std::any_of(defines_.begin(), defines_.end(), [](const auto& define) {
        return define.first == kWorkgroupSize;
    });
    if (files_.front().ends_with(".comp") && !given) {
        defines_.emplace_back(kWorkgroupSize, std::to_string(limits().workGroupSize));
    }
    std::vector<Source> sources;
    std::size_t textHash = 0;
    std::string key;
    for (const std::string& file : files_) {
        sources.push_back(resolve(file, defines_));
        textHash = hashOf(textHash, sources.back());
        key += file + " ";
    }
    for (const auto& [name, value] : defines_) key += name + "=" + value + " ";
    std::shared_ptr<Compiled>& known = compiledPrograms()[key + std::to_string(textHash)];
    if (!known) {
        auto compiled = std::make_shared<Compiled>();
        compiled->textHash = textHash;
        link(sources, *compiled);
        known = std::move(compiled);
    }
    compiled_ = known;
    enlist();
}

void Program::link(const std::vector<Source>& sources, Compiled& out) const {
    out.id = glCreateProgram();
    std::vector<GLuint> shaders;
    const auto release = [&] {
        for (GLuint shader : shaders) {
            glDetachShader(out.id, shader);
            glDeleteShader(shader);
        }
    };
    try {
        for (std::size_t i = 0; i < files_.size(); ++i) {
            shaders.push_back(compile(label_, files_[i], sources[i], defines_));
            glAttachShader(out.id, shaders.back());
        }
    } catch (...) {
        release();
        throw;
    }
    glLinkProgram(out.id);
    release();
    GLint linked = GL_FALSE;
    glGetProgramiv(out.id, GL_LINK_STATUS, &linked);
    if (!linked) {
        const std::string log = infoLog(
            out.id, [](auto... a) { glGetProgramiv(a...); },
            [](auto... a) { glGetProgramInfoLog(a...); });
        throw Error(ExitCode::graphics, "program \"" + label_ + "\" (" + joined(files_, ", ") +
                                            ") does not link:\n" + log);
    }
    glObjectLabel(GL_PROGRAM, out.id, static_cast<GLsizei>(label_.size()), label_.data());
    if (stageOf(files_.front()) == GL_COMPUTE_SHADER) {
        glGetProgramiv(out.id, GL_COMPUTE_WORK_GROUP_SIZE, &out.groupSize.x);
    }
}

void Program::enlist() {
    if (compiled_) {
        livePrograms().insert(this);
    } else {
        livePrograms().erase(this);
    }
}

Program::~Program() { livePrograms().erase(this); }

Program::Program(Program&& other) noexcept { *this = std::move(other); }

Program& Program::operator=(Program&& other) noexcept {
    std::swap(label_, other.label_);
    std::swap(files_, other.files_);
    std::swap(defines_, other.defines_);
    std::swap(compiled_, other.compiled_);
    enlist();
    other.enlist();
    return *this;
}

void Program::reload() { *this = Program(label_, files_, defines_); }

bool Program::outdated() const {
    std::size_t hash = 0;
    for (const std::string& file : files_) hash = hashOf(hash, resolve(file, defines_));
    return hash != compiled_->textHash;
}

std::vector<std::string> reloadPrograms() {
    shadersAreEdited() = true;
    if (shaderFolder().empty() && std::filesystem::is_directory(MEGAVIEWS_SHADERS "/passes")) {
        chosenFolder() = MEGAVIEWS_SHADERS;
    }
    // By name, not by address; a file that many programs share is told about once.
    std::vector<Program*> programs(livePrograms().begin(), livePrograms().end());
    std::sort(programs.begin(), programs.end(),
              [](const Program* a, const Program* b) { return a->label() < b->label(); });
    std::vector<std::string> messages;
    std::set<std::string> known;
    for (Program* program : programs) {
        try {
            if (program->outdated()) program->reload();
        } catch (const Error& error) {
            const std::string what = error.what();
            const std::size_t log = what.find('\n');
            if (known.insert(log == std::string::npos ? what : what.substr(log)).second)
                messages.push_back(what);
        }
    }
    // Versions that nobody uses any more.
    std::erase_if(compiledPrograms(), [](const auto& p) { return p.second.use_count() <= 1; });
    return messages;
}

glm::ivec3 Program::groupSize() const { return compiled_->groupSize; }

// How programs, and the draws and dispatches that run them, read and overwrite what shaders before
// stored in buffers and images.
constexpr GLbitfield kUsesOfShaders =
    GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
    GL_TEXTURE_FETCH_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT |
    GL_FRAMEBUFFER_BARRIER_BIT;

void Program::use() const {
    assert(compiled_);
    throwErrorWhereAsserted();
    glMemoryBarrier(kUsesOfShaders);
    glUseProgram(compiled_->id);
}

GLint Program::location(std::string_view name) {
    std::string key(name);
    const auto found = compiled_->locations.find(key);
    if (found != compiled_->locations.end()) return found->second;
    const GLint location = glGetUniformLocation(compiled_->id, key.c_str());
    if (location < 0 && !shadersAreEdited() &&
        !declares(files_, defines_, name.substr(0, name.find('[')))) {
        throw Error(ExitCode::graphics,
                    "program \"" + label_ + "\" has no uniform \"" + key + "\"");
    }
    compiled_->locations.emplace(std::move(key), location);
    return location;
}

// Location -1, a name that the compiler removed, is ignored by OpenGL.
void Program::set(std::string_view name, int value) {
    glProgramUniform1i(compiled_->id, location(name), value);
}
void Program::set(std::string_view name, std::uint32_t value) {
    glProgramUniform1ui(compiled_->id, location(name), value);
}
void Program::set(std::string_view name, float value) {
    glProgramUniform1f(compiled_->id, location(name), value);
}
void Program::set(std::string_view name, glm::vec2 value) {
    glProgramUniform2f(compiled_->id, location(name), value.x, value.y);
}
void Program::set(std::string_view name, glm::vec3 value) {
    glProgramUniform3f(compiled_->id, location(name), value.x, value.y, value.z);
}
void Program::set(std::string_view name, glm::vec4 value) {
    glProgramUniform4f(compiled_->id, location(name), value.x, value.y, value.z, value.w);
}
void Program::set(std::string_view name, glm::ivec2 value) {
    glProgramUniform2i(compiled_->id, location(name), value.x, value.y);
}
void Program::set(std::string_view name, glm::uvec4 value) {
    glProgramUniform4ui(compiled_->id, location(name), value.x, value.y, value.z, value.w);
}
void Program::set(std::string_view name, const glm::mat4& value) {
    glProgramUniformMatrix4fv(compiled_->id, location(name), 1, GL_FALSE, glm::value_ptr(value));
}

void Program::dispatchInvocations(std::uint64_t count) {
    const auto size = static_cast<std::uint64_t>(groupSize().x);
    dispatchGroups((count + size - 1) / size);
}

void Program::dispatchGroups(std::uint64_t groups) {
    if (groups == 0) return;
    const auto limit = static_cast<std::uint64_t>(limits().maxWorkGroupsX);
    const std::uint64_t rows = (groups + limit - 1) / limit;
    const std::uint64_t columns = (groups + rows - 1) / rows;
    assert(rows <= limit);
    use();
    glDispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>(rows), 1);
}

void Program::dispatch2D(int width, int height) {
    if (width <= 0 || height <= 0) return;
    use();
    glDispatchCompute(static_cast<GLuint>((width + groupSize().x - 1) / groupSize().x),
                      static_cast<GLuint>((height + groupSize().y - 1) / groupSize().y), 1);
}

void Program::dispatchIndirect(const Buffer& commands, std::uint64_t byteOffset) {
    use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, commands.id());
    glDispatchComputeIndirect(static_cast<GLintptr>(byteOffset));
}

void Program::drawFullScreen(const Framebuffer& target) const {
    use();
    target.bind();
    const VertexArray none("full screen");
    none.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace mv::gl
