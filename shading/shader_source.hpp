// From shader files to the text a driver compiles: version header, #defines, #include, and names in the driver's log.
// No OpenGL in here.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace nacre {

/// The three dialects every file of shaders/nacre is valid in.
enum class Glsl { V330, V450, Es300 };

std::string toString(Glsl dialect);  ///< 330, 450, es300

/// `#define first second`, in this order.
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;

/// Where the shaders are: the environment variable NACRE_SHADERS when set, else the source tree this was built from,
/// else share/nacre/shaders beside the running program's folder, else the installation folder.
/// \throws nacre::Error naming every folder tried; also when NACRE_SHADERS is set and is no folder
std::filesystem::path shaderFolder();

/// A piece of shader: the name that errors show, and its text.
struct ShaderText {
    std::string name, text;
};

/// What the driver gets. Source string number k of its messages is files[k].
struct ShaderSource {
    std::string text;
    std::vector<std::string> files;
};

/// \param file  relative to the first of `folders` that has it, for instance `nacre/half_diff.glsl`
/// \throws nacre::Error naming the file and the folders when it is in none of them
ShaderText readShader(const std::vector<std::filesystem::path>& folders, const std::string& file);

/// Header for `dialect` (for ES with precisions), the defines, then `entry` with each line `#include "file"` replaced
/// by that file, as often as it appears: files guard themselves (NACRE_NAME_GLSL), because an include within an #if may
/// be skipped by the compiler. An include of a file that is being included (a cycle) becomes an empty line.
/// #line directives keep line numbers and source string numbers right. An include of a file that is in no folder
/// becomes an #error that says so: whether its #if is taken is the compiler's business. \throws nacre::Error naming
/// file and line of a malformed #include
ShaderSource assembleShader(const std::vector<std::filesystem::path>& folders, const ShaderText& entry, Glsl dialect,
                            const ShaderDefines& defines = {});

/// Replaces the source string number that starts each message of a driver's log by the file's name:
/// `1:12(3): error` (Mesa), `1(12) : error` (NVIDIA) and `ERROR: 1:12:` (ANGLE) all become `nacre/x.glsl:12: …`.
std::string nameFilesInLog(const std::string& log, const std::vector<std::string>& files);

/// One `uniform` declaration: contract and setters check against these. arrayText is what stands between the
/// brackets, empty for a single value.
struct UniformDeclaration {
    std::string type, name, arrayText;
};

/// Every `uniform TYPE NAME[ARRAY];` of `text`, comments left out, whatever #if it stands in.
std::vector<UniformDeclaration> declaredUniforms(const std::string& text);

}  // namespace nacre
