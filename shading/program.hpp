// Compiled and linked shader programs, their uniforms, and a cache of them.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "shading/gl_objects.hpp"
#include "shading/shader_source.hpp"

namespace nacre {

/// An active uniform as the driver reports it: GLSL's name of the type, and 1 or the array's length.
struct ActiveUniform {
    std::string name, type;
    int count = 1;
};

/// A linked program. The setters leave it in use (glUseProgram). Setting a uniform that the source declares but the
/// driver dropped does nothing; one that the source doesn't declare is a mistake and throws.
class Program {
public:
    /// \throws nacre::Error with the driver's log, file names in place of source string numbers
    Program(const ShaderSource& vertex, const ShaderSource& fragment);

    GlName name() const { return program_.name(); }
    void use() const;
    std::vector<ActiveUniform> activeUniforms() const;
    bool declares(const std::string& uniform) const { return declared_.count(uniform) != 0; }

    /// \throws std::invalid_argument when no shader of this program declares `uniform`
    void set(const std::string& uniform, int value) const;
    void set(const std::string& uniform, float value) const;
    void set(const std::string& uniform, const glm::vec2& value) const;
    void set(const std::string& uniform, const glm::vec3& value) const;
    void set(const std::string& uniform, const glm::vec4& value) const;
    void set(const std::string& uniform, const glm::mat3& value) const;
    void set(const std::string& uniform, const glm::mat4& value) const;
    void set(const std::string& uniform, std::span<const glm::vec3> values) const;
    void set(const std::string& uniform, std::span<const glm::vec4> values) const;
    void set(const std::string& uniform, std::span<const glm::mat4> values) const;

private:
    int location(const std::string& uniform) const;  ///< uses the program; -1 when the driver dropped the uniform
    ProgramName program_;
    std::map<std::string, int> declared_;  ///< every declared uniform's location
};

/// Loads programs from folders and keeps them: the same files and defines give the same program.
/// The context that was current when a program was made must be current when it is used and when this is destroyed.
class ProgramLoader {
public:
    /// \param folders  searched in order, for the entry files and for #include
    explicit ProgramLoader(Glsl dialect = Glsl::V330, std::vector<std::filesystem::path> folders = {shaderFolder()});

    Glsl dialect() const { return dialect_; }
    const std::vector<std::filesystem::path>& folders() const { return folders_; }
    /// \throws nacre::Error naming file and line; nothing is kept then
    const Program& load(const std::string& vertexFile, const std::string& fragmentFile,
                        const ShaderDefines& defines = {});
    /// The same with the fragment shader's text at hand (uncached).
    Program compile(const std::string& vertexFile, const ShaderText& fragment, const ShaderDefines& defines = {}) const;

private:
    Glsl dialect_;
    std::vector<std::filesystem::path> folders_;
    std::map<std::string, std::unique_ptr<Program>> programs_;  ///< pointers: references stay valid
};

/// Compiles one shader and throws it away. For tests of files that have no program of their own.
/// \throws nacre::Error with the driver's log
void checkCompiles(const ShaderSource& fragment);

}  // namespace nacre
