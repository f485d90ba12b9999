// What every file of shaders/ must keep to: three dialects, guards, plain ASCII, uniforms in nacre/bind alone, and the
// contract.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <span>

#include "core/file.hpp"
#include "factorize/models/models.hpp"
#include "gpu_evaluate.hpp"
#include "shading/gpu_direct_brdf.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> shaderFiles(const std::string& under = "") {
    std::vector<std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(shaderFolder() / under))
        if (entry.path().extension() == ".glsl") out.push_back(fs::relative(entry.path(), shaderFolder()).string());
    std::sort(out.begin(), out.end());
    return out;
}

bool startsWith(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

std::string textOf(const std::string& file) { return readShader({shaderFolder()}, file).text; }

const std::pair<GlApi, Glsl> kDialects[] = {
    {GlApi::Core33, Glsl::V330}, {GlApi::Core45, Glsl::V450}, {GlApi::Es3, Glsl::Es300}};

/// The #defines under which a file of nacre/bind is compiled: each choice it knows.
std::vector<ShaderDefines> factoredChoices() {
    std::vector<ShaderDefines> out;
    for (const char* form : {"half_diff", "cosine", "single_lobe", "tangent", "homomorphic", "separable"}) {
        std::string name = std::string("NACRE_FORM_") + form;
        std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
        out.push_back({{"NACRE_FORM", name}});
    }
    return out;
}

std::vector<ShaderDefines> directChoices() {
    std::vector<ShaderDefines> out;
    for (const ModelInfo& info : listModels()) out.push_back(directBrdf(makeModel(info.name))->defines());
    for (const char* text : {"torrance-sparrow:d=ggx,f=conductor,eta=1/2/3", "torrance-sparrow:d=gaussian,f=schlick",
                             "torrance-sparrow:g=v-cavity,f=none,eta=1/2/3", "torrance-sparrow:eta=1/2/3",
                             "torrance-sparrow:f=conductor", "ggx:g=smith", "ward:variant=duer", "ward:variant=gmd"})
        out.push_back(directBrdf(makeModel(text))->defines());
    return out;
}

std::vector<ShaderDefines> prefilterChoices() {
    std::vector<ShaderDefines> out;
    for (const char* lobe :
         {"MIRROR", "DIFFUSE", "PHONG", "GGX", "BECKMANN", "GGX_REFRACTION", "BECKMANN_REFRACTION", "GGX_ANISOTROPIC"})
        out.push_back({{"NACRE_PREFILTER_LOBE", std::string("NACRE_PREFILTER_") + lobe}});
    return out;
}

/// Every step, with Lambert and with a BRDF, under a black sky and a surrounding.
std::vector<ShaderDefines> reliefChoices() {
    std::vector<ShaderDefines> out;
    for (const char* step : {"GATHER", "SKY", "SEGMENT", "TOTAL", "LEAVES"})
        for (const bool brdf : {true, false})
            for (const bool cube : {true, false}) {
                ShaderDefines defines = brdf ? factoredChoices().front() : ShaderDefines{};
                if (brdf) defines.emplace_back("NACRE_RELIEF_BRDF", "1");
                if (cube) defines.emplace_back("NACRE_RELIEF_SKY_CUBE", "1");
                defines.emplace_back("NACRE_RELIEF_STEP", std::string("NACRE_RELIEF_") + step);
                out.push_back(std::move(defines));
            }
    return out;
}

/// Every layout with every role; every weight and combination.
std::vector<ShaderDefines> environmentChoices() {
    std::vector<ShaderDefines> out{{}};
    const char* weights[] = {"NACRE_ENV_ONE", "NACRE_ENV_FRESNEL", "NACRE_ENV_SCALE_BIAS",
                             "NACRE_ENV_SCALE_BIAS_MULTIPLE"};
    int next = 0;
    for (const char* layout :
         {"NACRE_ENV_CUBE", "NACRE_ENV_LATLONG", "NACRE_ENV_DUAL_PARABOLOID", "NACRE_ENV_OCTAHEDRAL"})
        out.push_back({{"NACRE_ENV_LAYOUT", layout},
                       {"NACRE_ENV_REFLECTION", "1"},
                       {"NACRE_ENV_TRANSMISSION", "1"},
                       {"NACRE_ENV_DIFFUSE", "1"},
                       {"NACRE_ENV_WEIGHT", weights[next++]},
                       {"NACRE_ENV_COMBINE", next % 2 == 0 ? "NACRE_ENV_ADD" : "NACRE_ENV_BLEND"}});
    return out;
}

/// Every shadow; every other choice once.
std::vector<ShaderDefines> bumpChoices() {
    const std::pair<std::string, std::string> on{"NACRE_BUMP", "1"}, soft{"NACRE_BUMP_SOFT", "1"};
    const std::pair<std::string, std::string> ellipse{"NACRE_BUMP_SHADOW", "NACRE_BUMP_ELLIPSE"},
        horizon{"NACRE_BUMP_SHADOW", "NACRE_BUMP_HORIZON"};
    return {
        {on, ellipse, soft, {"NACRE_BUMP_INDIRECT", "0"}, {"NACRE_BUMP_MIRROR", "1"}, {"NACRE_BUMP_ROUGHNESS", "1"}},
        {on, horizon, soft},
        {on, ellipse},
        {on, horizon},
        {on}};
}

/// Every kind of map, for one light each; and eight at once.
std::vector<ShaderDefines> shadowChoices() {
    std::vector<ShaderDefines> out;
    ShaderDefines all{{"NACRE_SHADOWS", "1"}};
    const char* kinds[] = {"SPOT", "DIRECTIONAL", "CUBE", "DUAL_PARABOLOID"};
    for (int i = 0; i < 8; ++i) {
        const std::string kind = std::string("NACRE_SHADOW_") + kinds[i % 4], at = std::to_string(i);
        const auto add = [&](ShaderDefines& to, const std::string& light) {
            to.emplace_back("NACRE_SHADOW_" + light,
                            kind + ", " + std::to_string(1 + i % 5) + (i % 3 == 0 ? ", 16" : ", 32") + ", 3");
        };
        add(all, at);
        if (i < 4) add(out.emplace_back(ShaderDefines{{"NACRE_SHADOWS", "1"}}), "0");
    }
    out.push_back(all);
    return out;
}

/// Each of `first` with each of `second`.
std::vector<ShaderDefines> combined(const std::vector<ShaderDefines>& first, const std::vector<ShaderDefines>& second) {
    std::vector<ShaderDefines> out;
    for (const ShaderDefines& a : first)
        for (const ShaderDefines& b : second) {
            out.push_back(a);
            out.back().insert(out.back().end(), b.begin(), b.end());
        }
    return out;
}

std::vector<ShaderDefines> choicesFor(const std::string& file) {
    if (file == "nacre/bind/factored_brdf.glsl") return factoredChoices();
    if (file == "nacre/bind/direct_brdf.glsl") return directChoices();
    if (file == "nacre/bind/environment.glsl") return environmentChoices();
    if (file == "nacre/bind/brdf.glsl") {
        std::vector<ShaderDefines> out = factoredChoices();
        for (ShaderDefines& defines : directChoices()) out.push_back(std::move(defines));
        return out;
    }
    if (file == "nacre/bind/bump.glsl") return bumpChoices();
    if (file == "nacre/bind/lamps.glsl")  // a table, and a microfacet model for the roughness
        return combined({factoredChoices().front(), directBrdf(makeModel("ggx"))->defines()}, bumpChoices());
    if (file == "nacre/bind/shadows.glsl") return shadowChoices();
    if (file == "nacre/prefilter.glsl") return prefilterChoices();
    return {{}};
}

TEST(ShaderFiles, EveryLibraryFileCompilesInThreeDialects) {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    const auto files = shaderFiles("nacre");
    EXPECT_GE(files.size(), 10u);
    for (const auto& [api, dialect] : kDialects) {
        test::context(api);
        for (const std::string& file : files)
            for (const ShaderDefines& defines : choicesFor(file)) {
                const ShaderText entry{
                    "entry", "#include \"" + file + "\"\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n"};
                EXPECT_NO_THROW(checkCompiles(assembleShader({shaderFolder()}, entry, dialect, defines)))
                    << file << " as " << toString(dialect);
            }
    }
}

struct ProgramCase {
    std::string vertex, fragment;
    std::vector<ShaderDefines> choices;
    bool desktop = false;  ///< not in ES, which has no clip distances
};

/// Every program of the runtime in every variant. A .frag.glsl that is missing here fails the test below.
std::vector<ProgramCase> programs() {
    std::vector<ProgramCase> out;
    const std::vector<ShaderDefines> brdfs = choicesFor("nacre/bind/brdf.glsl");
    out.push_back({"lit.vert.glsl", "lit.frag.glsl", brdfs});
    out.push_back({"lit.vert.glsl", "lit.frag.glsl", choicesFor("nacre/bind/lamps.glsl")});
    ShaderDefines spots = brdfs.front();
    spots.emplace_back("NACRE_LIGHT_CONES", "1");
    out.push_back({"lit.vert.glsl", "lit.frag.glsl", {spots}});
    out.push_back({"lit_vertex.vert.glsl", "lit_vertex.frag.glsl", {spots, brdfs.front(), brdfs.back()}});
    out.push_back({"lit.vert.glsl", "lit.frag.glsl", combined({brdfs.front()}, shadowChoices())});
    out.push_back({"lit.vert.glsl", "shadow_mask.frag.glsl", shadowChoices()});
    out.push_back({"vertex_light.vert.glsl", "vertex_light.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "shadow_blocks.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "alpha_copy.frag.glsl", {{}}});
    std::vector<ShaderDefines> alpha;
    for (const char* step : {"NACRE_ALPHA_TEST", "NACRE_ALPHA_RAMP", "NACRE_ALPHA_MAP"})
        alpha.push_back({{"NACRE_ALPHA_STEP", step}});
    alpha.push_back({{"NACRE_ALPHA_STEP", "NACRE_ALPHA_RAMP"}, {"NACRE_ALPHA_FROM_LIGHT", "1"}});
    out.push_back({"alpha_shadow.vert.glsl", "alpha_shadow.frag.glsl", alpha});
    out.push_back({"shadow_map.vert.glsl",
                   "shadow_map.frag.glsl",
                   {{}, {{"NACRE_SHADOW_PARABOLOID", "1"}}, {{"NACRE_SHADOW_SLICES", "1"}}}});
    out.push_back({"fullscreen.vert.glsl",
                   "shadow_volume.frag.glsl",
                   {{}, {{"NACRE_SHADOW_PARABOLOID", "1"}}, {{"NACRE_SHADOW_PARALLEL", "1"}}}});
    std::vector<ShaderDefines> matrix;
    for (ShaderDefines defines : factoredChoices())
        if (defines[0].second == "NACRE_FORM_COSINE" || defines[0].second == "NACRE_FORM_TANGENT") {
            defines.push_back({"NACRE_TEXTURE_MATRIX", "1"});
            matrix.push_back(defines);
        }
    out.push_back({"lit_matrix.vert.glsl", "lit_matrix.frag.glsl", matrix});
    out.push_back({"fullscreen.vert.glsl", "prefilter.frag.glsl", prefilterChoices()});
    out.push_back({"fullscreen.vert.glsl", "prefilter_copy.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "prefilter_halve.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "present.frag.glsl", {{}}});
    out.push_back({"stencil_volume.vert.glsl",
                   "stencil.frag.glsl",
                   {{}, {{"NACRE_STENCIL_CUT", "1"}}, {{"NACRE_STENCIL_BEYOND_FAR", "1"}}, {{"NACRE_VIEW", "1"}}},
                   true});
    out.push_back({"item_buffer.vert.glsl", "item_buffer.frag.glsl", {{}}});
    out.push_back({"lit.vert.glsl", "geometry.frag.glsl", {{}}});
    out.push_back(
        {"stencil_volume.vert.glsl", "counted_volume.frag.glsl", {{{"NACRE_STENCIL_BEYOND_NEAR", "1"}}}, true});
    out.push_back({"fullscreen.vert.glsl", "counted_add.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "counted_mask.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "pipe_add.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl",
                   "shadow_filter.frag.glsl",
                   {{{"NACRE_FILTER_RADIUS", "3"}, {"NACRE_EDGE_STOPPING", "0"}},
                    {{"NACRE_FILTER_RADIUS", "3"}, {"NACRE_EDGE_STOPPING", "1"}}}});
    out.push_back({"point_map.vert.glsl", "point_map.frag.glsl", {{}}});
    out.push_back({"fullscreen.vert.glsl", "mapped_shadow.frag.glsl", {{{"NACRE_POINTS", "64"}}}});
    for (const char* near : {"NACRE_VIRTUAL_POINT", "NACRE_VIRTUAL_DISK", "NACRE_VIRTUAL_RECTANGLE"})
        out.push_back({"fullscreen.vert.glsl", "indirect.frag.glsl",
                       combined({{{"NACRE_VIRTUAL_NEAR", near}}}, {{}, {{"NACRE_VIRTUAL_SHADOWS", "1"}}})});
    const std::vector<ShaderDefines> surroundings = environmentChoices();
    out.push_back({"lit.vert.glsl", "environment.frag.glsl", {surroundings.rbegin(), surroundings.rend()}});
    out.push_back({"sky.vert.glsl", "sky.frag.glsl", surroundings});
    std::vector<ShaderDefines> both;
    for (ShaderDefines defines : surroundings) {
        defines.insert(defines.begin(), brdfs.front().begin(), brdfs.front().end());
        both.push_back(std::move(defines));
    }
    out.push_back({"lit.vert.glsl", "lit_environment.frag.glsl", both});
    out.push_back({"fullscreen.vert.glsl", "relief_light.frag.glsl", reliefChoices()});
    out.push_back({"lit.vert.glsl", "lit_environment.frag.glsl", combined({both.back()}, bumpChoices())});
    out.push_back({"lit.vert.glsl", "environment.frag.glsl", combined({surroundings.back()}, bumpChoices())});
    // Of scenes: ambient alone, lamps, the surrounding, both; each relief with everything.
    const ShaderDefines lamps{{"NACRE_SCENE_LAMPS", "1"}}, surrounding{{"NACRE_SCENE_SURROUNDING", "1"}};
    const ShaderDefines everything = combined(combined({both.back()}, {lamps}), {surrounding}).front();
    std::vector<ShaderDefines> volumes{{}, everything, combined({surroundings.back()}, {surrounding}).front()};
    for (const ShaderDefines& shadow : shadowChoices())
        volumes.push_back(combined(combined({brdfs.front()}, {lamps}), {shadow}).front());
    out.push_back({"volume.vert.glsl", "volume.frag.glsl", combined(volumes, {{}, {{"NACRE_VOLUME_MARCH", "1"}}})});
    std::vector<ShaderDefines> scenes = combined({everything}, bumpChoices());
    scenes.push_back({{"NACRE_VERTEX_RADIANCE", "1"}});
    scenes.push_back({});
    scenes.push_back(combined({brdfs.front()}, {lamps}).front());
    scenes.push_back(combined({surroundings.back()}, {surrounding}).front());
    scenes.push_back(everything);
    out.push_back({"lit.vert.glsl", "scene.frag.glsl", scenes});
    // From virtual viewpoints.
    const ShaderDefines view{{"NACRE_VIEW", "1"}};
    out.push_back({"lit.vert.glsl", "face.frag.glsl", {view}, true});
    out.push_back({"sky.vert.glsl", "background.frag.glsl", {view}, true});
    out.push_back({"sky.vert.glsl", "sky.frag.glsl", combined({surroundings.back()}, {view}), true});
    out.push_back({"lit.vert.glsl", "scene.frag.glsl", combined({{}, everything}, {view}), true});
    const ShaderDefines filtered{{"NACRE_VIEW", "1"}, {"NACRE_VIEW_FILTERS", "2"}};
    out.push_back({"lit.vert.glsl", "face.frag.glsl", {filtered}, true});
    out.push_back({"sky.vert.glsl", "background.frag.glsl", {filtered}, true});
    out.push_back({"sky.vert.glsl", "sky.frag.glsl", combined({surroundings.back()}, {filtered}), true});
    const ShaderDefines path{{"NACRE_LIGHT_PATH", "2"}, {"NACRE_PATH_IMAGES", "2"}};
    out.push_back({"lit.vert.glsl", "scene.frag.glsl", combined(combined({everything}, {path}), {filtered}), true});
    out.push_back({"lit.vert.glsl", "scene.frag.glsl", combined(combined({everything}, {path}), {view}), true});
    out.push_back({"lit_vertex.vert.glsl", "lit_vertex.frag.glsl", combined({spots}, {view}), true});
    out.push_back({"volume.vert.glsl", "volume.frag.glsl",
                   combined(combined({everything}, {{}, {{"NACRE_VOLUME_MARCH", "1"}}}), {view}), true});
    return out;
}

/// "vec4" or "vec4[16]" for each uniform that the contract names.
std::map<std::string, std::string> contract() {
    const nlohmann::json json = nlohmann::json::parse(textOf("nacre/contract.json"));
    std::map<std::string, std::string> out;
    for (const auto& [file, uniforms] : json.at("uniforms").items())
        for (const auto& [name, type] : uniforms.items()) out[name] = type.get<std::string>();
    return out;
}

TEST(Contract, HoldsEveryActiveUniformOfEveryProgram) {
    const auto known = contract();
    std::set<std::string> fragments;
    for (const auto& [api, dialect] : kDialects) {
        test::context(api);
        const ProgramLoader loader(dialect);
        for (const ProgramCase& program : programs()) {
            fragments.insert(program.fragment);
            if (program.desktop && api == GlApi::Es3) continue;
            // every BRDF as 330; the programs' own text in each dialect, with one BRDF, and with five reliefs
            const ShaderDefines& firstChoice = program.choices.front();
            const bool relief = !firstChoice.empty() && startsWith(firstChoice.back().first, "NACRE_BUMP");
            const std::size_t choices = dialect == Glsl::V330
                                            ? program.choices.size()
                                            : std::min<std::size_t>(relief ? 5 : 1, program.choices.size());
            for (const ShaderDefines& defines : std::span(program.choices).first(choices)) {
                const Program linked =
                    loader.compile(program.vertex, readShader({shaderFolder()}, program.fragment), defines);
                for (const ActiveUniform& uniform : linked.activeUniforms()) {
                    ASSERT_EQ(known.count(uniform.name), 1u) << uniform.name << " in " << program.fragment;
                    const std::string type = known.at(uniform.name), base = type.substr(0, type.find('['));
                    EXPECT_EQ(uniform.type, base) << uniform.name;
                    const int declared = base == type ? 1 : std::stoi(type.substr(base.size() + 1));
                    EXPECT_LE(uniform.count, declared) << uniform.name;  // drivers cut arrays to what is used
                }
            }
        }
    }
    for (const std::string& file : shaderFiles()) {
        if (file.find(".frag.glsl") == std::string::npos) continue;
        EXPECT_EQ(fragments.count(file), 1u) << file << " is in no case";
    }
}

// Both ways: drivers drop unused uniforms, so this looks at the sources.
TEST(Contract, IsWhatTheSourcesDeclare) {
    const nlohmann::json uniforms = nlohmann::json::parse(textOf("nacre/contract.json")).at("uniforms");
    nlohmann::json declared = nlohmann::json::object();
    for (const std::string& file : shaderFiles())
        for (const UniformDeclaration& u : declaredUniforms(textOf(file))) {
            EXPECT_TRUE(startsWith(file, "nacre/bind/")) << file << " declares " << u.name;
            EXPECT_TRUE(startsWith(u.name, "nacre_")) << u.name;
            declared[file][u.name] = u.arrayText.empty() ? u.type : u.type + "[" + u.arrayText + "]";
        }
    EXPECT_EQ(uniforms, declared) << declared.dump(2);
}

TEST(ShaderFiles, KeepToTheHouseStyle) {
    for (const std::string& file : shaderFiles()) {
        const std::string text = textOf(file);
        EXPECT_TRUE(std::all_of(text.begin(), text.end(), [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }))
            << file << " has a character that is no plain ASCII";
        EXPECT_EQ(text.find("#version"), std::string::npos) << file;
        if (!startsWith(file, "nacre/")) continue;
        std::string guard = file.substr(0, file.size() - 5) + "_GLSL";
        std::transform(guard.begin(), guard.end(), guard.begin(),
                       [](unsigned char c) { return c == '/' ? '_' : std::toupper(c); });
        EXPECT_NE(text.find("#ifndef " + guard + "\n#define " + guard + "\n"), std::string::npos)
            << file << ": " << guard;
        EXPECT_FALSE(std::regex_search(text, std::regex(R"(\bvoid\s+main\b)"))) << file;
    }
}

// Every GLSL function that the library offers is named in a test or reached from one that is: here, that each is
// called from another shader or from the tests' own GLSL.
TEST(ShaderFiles, EveryFunctionIsUsed) {
    const std::regex function(R"(\n(?:vec[234]|mat[34]|float|int|bool)\s+(nacre_\w+)\s*\()");
    std::string everything;
    for (const std::string& file : shaderFiles()) everything += textOf(file);
    for (const auto& entry : fs::recursive_directory_iterator(NACRE_SOURCE_DIR "/tests/shading"))
        if (entry.is_regular_file()) {
            const auto bytes = readFile(entry.path(), 1 << 20);
            everything.append(bytes.begin(), bytes.end());
        }
    for (const std::string& file : shaderFiles("nacre")) {
        const std::string text = textOf(file);
        for (std::sregex_iterator at(text.begin(), text.end(), function), end; at != end; ++at) {
            const std::string name = (*at)[1];
            int count =
                0;  // of calls: a word of its own. By find: a regular expression takes a minute under sanitizers
            for (auto i = everything.find(name + "("); i != std::string::npos; i = everything.find(name + "(", i + 1))
                count += i > 0 && everything[i - 1] != '_' &&
                         std::isalnum(static_cast<unsigned char>(everything[i - 1])) == 0;
            EXPECT_GE(count, 2) << name << " of " << file << " is never called";
        }
    }
}

}  // namespace
}  // namespace nacre
