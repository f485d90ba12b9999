#include "shading/program.hpp"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/type_ptr.hpp>

#include "core/error.hpp"

namespace nacre {
namespace {

/// A shader object lives only until its program is linked.
class Shader {
public:
    Shader(GLenum stage, const ShaderSource& source) : name_(glCreateShader(stage)) {
        const char* text = source.text.c_str();
        glShaderSource(name_, 1, &text, nullptr);
        glCompileShader(name_);
        GLint ok = GL_FALSE, length = 0;
        glGetShaderiv(name_, GL_COMPILE_STATUS, &ok);
        if (ok) return;
        glGetShaderiv(name_, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
        glGetShaderInfoLog(name_, length, nullptr, log.data());
        glDeleteShader(name_);
        throw Error(
            fmt::format("{} does not compile:\n{}", source.files.front(), nameFilesInLog(log.c_str(), source.files)));
    }
    ~Shader() { glDeleteShader(name_); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    GLuint name() const { return name_; }

private:
    GLuint name_;
};

std::string typeName(GLenum type) {
    switch (type) {
        case GL_FLOAT:
            return "float";
        case GL_FLOAT_VEC2:
            return "vec2";
        case GL_FLOAT_VEC3:
            return "vec3";
        case GL_FLOAT_VEC4:
            return "vec4";
        case GL_INT:
            return "int";
        case GL_BOOL:
            return "bool";
        case GL_FLOAT_MAT3:
            return "mat3";
        case GL_FLOAT_MAT4:
            return "mat4";
        case GL_SAMPLER_2D:
            return "sampler2D";
        case GL_SAMPLER_2D_ARRAY:
            return "sampler2DArray";
        case GL_SAMPLER_3D:
            return "sampler3D";
        case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
            return "usampler2DArray";
        case GL_SAMPLER_CUBE:
            return "samplerCube";
        default:
            return fmt::format("type 0x{:04x}", type);
    }
}

std::string linkLog(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program, length, nullptr, log.data());
    return log.c_str();
}

}  // namespace

Program::Program(const ShaderSource& vertex, const ShaderSource& fragment) {
    const Shader vertexShader(GL_VERTEX_SHADER, vertex), fragmentShader(GL_FRAGMENT_SHADER, fragment);
    glAttachShader(name(), vertexShader.name());
    glAttachShader(name(), fragmentShader.name());
    glLinkProgram(name());
    GLint ok = GL_FALSE;
    glGetProgramiv(name(), GL_LINK_STATUS, &ok);
    if (!ok)
        throw Error(
            fmt::format("{} and {} do not link:\n{}", vertex.files.front(), fragment.files.front(), linkLog(name())));
    glDetachShader(name(), vertexShader.name());
    glDetachShader(name(), fragmentShader.name());
    for (const ShaderSource* source : {&vertex, &fragment})
        for (const UniformDeclaration& uniform : declaredUniforms(source->text))
            declared_[uniform.name] = glGetUniformLocation(name(), uniform.name.c_str());
}

void Program::use() const { glUseProgram(name()); }

std::vector<ActiveUniform> Program::activeUniforms() const {
    GLint count = 0;
    glGetProgramiv(name(), GL_ACTIVE_UNIFORMS, &count);
    std::vector<ActiveUniform> out;
    for (GLint i = 0; i < count; ++i) {
        char text[256] = {};
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(name(), static_cast<GLuint>(i), sizeof(text), nullptr, &size, &type, text);
        const std::string full(text);
        out.push_back({full.substr(0, full.find('[')), typeName(type), size});
    }
    return out;
}

int Program::location(const std::string& uniform) const {
    const auto at = declared_.find(uniform);
    if (at == declared_.end())
        throw std::invalid_argument("Program::set: no shader of this program declares uniform " + uniform);
    use();
    return at->second;
}

void Program::set(const std::string& uniform, int value) const { glUniform1i(location(uniform), value); }
void Program::set(const std::string& uniform, float value) const { glUniform1f(location(uniform), value); }
void Program::set(const std::string& uniform, const glm::vec2& value) const {
    glUniform2fv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const std::string& uniform, const glm::vec3& value) const {
    glUniform3fv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const std::string& uniform, const glm::vec4& value) const {
    glUniform4fv(location(uniform), 1, glm::value_ptr(value));
}
void Program::set(const std::string& uniform, const glm::mat3& value) const {
    glUniformMatrix3fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const std::string& uniform, const glm::mat4& value) const {
    glUniformMatrix4fv(location(uniform), 1, GL_FALSE, glm::value_ptr(value));
}
void Program::set(const std::string& uniform, std::span<const glm::vec3> values) const {
    if (values.empty()) return;
    glUniform3fv(location(uniform), static_cast<GLsizei>(values.size()), glm::value_ptr(values[0]));
}
void Program::set(const std::string& uniform, std::span<const glm::vec4> values) const {
    if (values.empty()) return;
    glUniform4fv(location(uniform), static_cast<GLsizei>(values.size()), glm::value_ptr(values[0]));
}
void Program::set(const std::string& uniform, std::span<const glm::mat4> values) const {
    if (values.empty()) return;
    glUniformMatrix4fv(location(uniform), static_cast<GLsizei>(values.size()), GL_FALSE, glm::value_ptr(values[0]));
}

ProgramLoader::ProgramLoader(Glsl dialect, std::vector<std::filesystem::path> folders)
    : dialect_(dialect), folders_(std::move(folders)) {}

const Program& ProgramLoader::load(const std::string& vertexFile, const std::string& fragmentFile,
                                   const ShaderDefines& defines) {
    std::string key = vertexFile + '\n' + fragmentFile;
    for (const auto& [name, value] : defines) key += '\n' + name + ' ' + value;
    std::unique_ptr<Program>& kept = programs_[key];
    try {
        if (!kept) kept = std::make_unique<Program>(compile(vertexFile, readShader(folders_, fragmentFile), defines));
    } catch (...) {
        programs_.erase(key);
        throw;
    }
    return *kept;
}

Program ProgramLoader::compile(const std::string& vertexFile, const ShaderText& fragment,
                               const ShaderDefines& defines) const {
    return {assembleShader(folders_, readShader(folders_, vertexFile), dialect_, defines),
            assembleShader(folders_, fragment, dialect_, defines)};
}

void checkCompiles(const ShaderSource& fragment) { const Shader shader(GL_FRAGMENT_SHADER, fragment); }

}  // namespace nacre
