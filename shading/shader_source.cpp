#include "shading/shader_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <regex>
#include <sstream>

#include "core/error.hpp"
#include "core/file.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxShaderBytes = 1u << 20;

std::string listFolders(const std::vector<fs::path>& folders) {
    std::string out;
    for (const fs::path& folder : folders) out += (out.empty() ? "" : ", ") + folder.string();
    return out;
}

std::string header(Glsl dialect) {
    switch (dialect) {
        case Glsl::V330:
            return "#version 330 core\n";
        case Glsl::V450:
            return "#version 450 core\n";
        case Glsl::Es300:
            return "#version 300 es\n"
                   "precision highp float;\nprecision highp int;\n"
                   "precision highp sampler2D;\nprecision highp samplerCube;\nprecision highp sampler3D;\n"
                   "precision highp sampler2DArray;\nprecision highp usampler2DArray;\nprecision highp "
                   "sampler2DShadow;\n";
    }
    return {};
}

/// The text being built and the files on the way down to the line at hand.
struct Assembly {
    const std::vector<fs::path>& folders;
    ShaderSource source;
    std::vector<std::string> open;
};

std::size_t fileNumber(std::vector<std::string>& files, const std::string& name) {
    const auto at = std::find(files.begin(), files.end(), name);
    if (at != files.end()) return static_cast<std::size_t>(at - files.begin());
    files.push_back(name);
    return files.size() - 1;
}

std::optional<ShaderText> findShader(const std::vector<fs::path>& folders, const std::string& file) {
    std::error_code ignored;
    for (const fs::path& folder : folders) {
        if (!fs::is_regular_file(folder / file, ignored)) continue;
        const std::vector<std::uint8_t> bytes = readFile(folder / file, kMaxShaderBytes);
        return ShaderText{file, std::string(bytes.begin(), bytes.end())};
    }
    return {};
}

void append(Assembly& out, const ShaderText& shader);

void appendInclude(Assembly& out, const ShaderText& shader, const std::string& line, int number) {
    static const std::regex kInclude(R"re(^\s*#\s*include\s+"([^"]+)"\s*(//.*)?$)re");
    const std::string where = fmt::format("{}:{}", shader.name, number);
    std::smatch match;
    if (!std::regex_match(line, match, kInclude))
        throw Error(fmt::format("{}: expected #include \"file\", found: {}", where, line));
    const std::string file = match[1];
    if (std::find(out.open.begin(), out.open.end(), file) != out.open.end()) {
        out.source.text += '\n';
        return;
    }
    const std::optional<ShaderText> included = findShader(out.folders, file);
    if (!included) {  // an #if may leave this line out, so the compiler decides
        out.source.text += fmt::format("#error no shader file {} in {}\n", file, listFolders(out.folders));
        return;
    }
    append(out, *included);
    const std::size_t self = fileNumber(out.source.files, shader.name);
    out.source.text += fmt::format("#line {} {}\n", number + 1, self);
}

void append(Assembly& out, const ShaderText& shader) {
    static const std::regex kDirective(R"re(^\s*#\s*include\b.*)re");
    out.open.push_back(shader.name);
    out.source.text += fmt::format("#line 1 {}\n", fileNumber(out.source.files, shader.name));
    std::istringstream lines(shader.text);
    int number = 1;
    for (std::string line; std::getline(lines, line); ++number) {
        if (std::regex_match(line, kDirective))
            appendInclude(out, shader, line, number);
        else
            out.source.text += line + '\n';
    }
    out.open.pop_back();
}

/// Comments become blanks; line breaks stay.
std::string withoutComments(const std::string& text) {
    std::string out = text;
    enum { Code, Line, Block } state = Code;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const char next = i + 1 < out.size() ? out[i + 1] : '\0';
        if (state == Code && out[i] == '/' && next == '/') state = Line;
        if (state == Code && out[i] == '/' && next == '*') state = Block;
        if (state == Line && out[i] == '\n') state = Code;
        if (state == Block && out[i] == '*' && next == '/') {
            out[i] = out[i + 1] = ' ';
            state = Code;
        }
        if (state != Code && out[i] != '\n') out[i] = ' ';
    }
    return out;
}

}  // namespace

std::string toString(Glsl dialect) {
    switch (dialect) {
        case Glsl::V330:
            return "330";
        case Glsl::V450:
            return "450";
        case Glsl::Es300:
            return "es300";
    }
    return "?";
}

fs::path shaderFolder() {
    std::error_code ignored;
    if (const char* chosen = std::getenv("NACRE_SHADERS"); chosen && *chosen) {
        if (fs::is_directory(chosen, ignored)) return chosen;
        throw Error(fmt::format("{}: expected a folder of shaders (NACRE_SHADERS), found none", chosen));
    }
    std::vector<fs::path> tried{NACRE_SHADERS_SOURCE};
    if (const fs::path program = fs::read_symlink("/proc/self/exe", ignored); !program.empty())
        tried.push_back(program.parent_path().parent_path() / "share" / "nacre" / "shaders");
    tried.emplace_back(NACRE_SHADERS_INSTALLED);
    for (const fs::path& folder : tried)
        if (fs::is_directory(folder / "nacre", ignored)) return folder;
    throw Error("no folder of shaders; set NACRE_SHADERS; tried: " + listFolders(tried));
}

ShaderText readShader(const std::vector<fs::path>& folders, const std::string& file) {
    if (std::optional<ShaderText> found = findShader(folders, file)) return *found;
    throw Error(fmt::format("no shader file {} in {}", file, listFolders(folders)));
}

ShaderSource assembleShader(const std::vector<fs::path>& folders, const ShaderText& entry, Glsl dialect,
                            const ShaderDefines& defines) {
    Assembly out{folders, {}, {}};
    out.source.text = header(dialect);
    for (const auto& [name, value] : defines) out.source.text += fmt::format("#define {} {}\n", name, value);
    append(out, entry);
    return std::move(out.source);
}

std::string nameFilesInLog(const std::string& log, const std::vector<std::string>& files) {
    static const std::regex kPlace(R"(^((?:ERROR|WARNING):\s*)?(\d+)(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:?)");
    std::string out;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
        std::smatch match;
        if (std::regex_search(line, match, kPlace)) {
            const auto file = static_cast<std::size_t>(std::stoul(match[2]));
            const std::string number = match[3].matched ? match[3].str() : match[4].str();
            if (file < files.size())
                line = fmt::format("{}{}:{}:{}", match[1].str(), files[file], number, match.suffix().str());
        }
        out += line + '\n';
    }
    return out;
}

std::vector<UniformDeclaration> declaredUniforms(const std::string& text) {
    static const std::regex kUniform(R"(\buniform\s+(?:(?:lowp|mediump|highp)\s+)?(\w+)\s+([^;{]+);)");
    static const std::regex kName(R"(\s*(\w+)\s*(?:\[\s*(\w+)\s*\])?\s*)");
    std::vector<UniformDeclaration> out;
    const std::string code = withoutComments(text);
    for (std::sregex_iterator at(code.begin(), code.end(), kUniform), end; at != end; ++at) {
        std::istringstream names((*at)[2]);
        for (std::string name; std::getline(names, name, ',');) {
            std::smatch match;
            if (std::regex_match(name, match, kName)) out.push_back({(*at)[1], match[1], match[2]});
        }
    }
    return out;
}

}  // namespace nacre
