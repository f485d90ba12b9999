#include "demos/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace nacre {
namespace {

constexpr const char* kFigure2 = "Torrance–Sparrow at two roughnesses (HSE figure 2)";
constexpr const char* kFigure3 = "Isotropic, circular and radial anisotropy (HSE figure 3)";
constexpr const char* kFigure4 = "Simulated micro-geometry (HSE figure 4)";
constexpr const char* kFits = "Measured materials: published fits on scanned meshes";
constexpr const char* kFiles = "Measured materials: files on this machine";

/// Refractive index and extinction near 610, 550 and 465 nm, after Johnson & Christy 1972.
constexpr const char* kCopper = "f=conductor,eta=0.27/0.95/1.17,k=3.4/2.58/2.4";
/// Ridges across the tangent: what faces -x (the handle's side) is blue, what faces +x red.
constexpr const char* kRidges = "micro:ridges,slope=0.8,left=0.02/0.05/0.8,right=0.8/0.03/0.02";
constexpr const char* kSilver = "f=conductor,eta=0.06/0.06/0.05,k=4.1/3.6/2.9";

Recipe torus(const char* id, const char* alpha, const char* method, int size, const char* title, const char* caption) {
    Recipe r;
    r.id = id;
    r.section = kFigure2;
    r.title = title;
    r.caption = caption;
    r.stage = "torus";
    r.white = 1.2;
    r.source = fmt::format("torrance-sparrow:d=beckmann,g=smith,alpha={},{},ks=0.5,kd=0.3/0.12/0.06", alpha, kCopper);
    r.bake.method = method;
    r.bake.size = size;
    r.allAddressings = std::string(method) == "cosine";
    return r;
}

std::vector<Recipe> figure2() {
    return {
        torus("torus-smooth", "0.2", "cosine", 128, "Torus, copper, alpha 0.2",
              "Beckmann facets and Smith's shadowing, factored as the paper prints it: F·D over (cosθ, cosδ) in "
              "one texture, G/(4 cosα cosβ) in the other, linear in the cosines. The textures are addressed per "
              "pixel; per vertex, with interpolated vectors that are not normalised again; and by the texture "
              "matrices of equations 2 and 3."),
        torus("torus-rough", "0.5", "cosine", 64, "Torus, copper, alpha 0.5",
              "The same surface rougher: a wide lobe needs no fine steps near cosδ = 1, so smaller textures do."),
        torus(
            "torus-adaptive", "0.2", "analytic", 64, "Torus, copper, alpha 0.2, adaptive coordinates",
            "The smooth one again in a quarter of the bytes: the tables hold logarithms, their coordinates follow the "
            "lobe, and they are fitted through the texture filter. Texture matrices can't make these "
            "coordinates.")};
}

Recipe figure3(const char* id, const char* stage, const char* title, const char* caption, std::string source) {
    Recipe r;
    r.id = id;
    r.section = kFigure3;
    r.title = title;
    r.caption = caption;
    r.stage = stage;
    r.source = std::move(source);
    return r;
}

std::vector<Recipe> figure3() {
    const std::string banks = "banks:kd=0.06/0.055/0.05,ks=0.8/0.75/0.65,n=60";
    const std::string ggx = fmt::format("ggx:alphax=0.08,alphay=0.4,{},kd=0.06", kSilver);
    const std::string ward = "ward:alphax=0.1,alphay=0.35,ks=0.5,kd=0.12/0.05/0.03";
    return {figure3("isotropic", "disk-sphere-circular", "Isotropic: Blinn–Phong",
                    "Diffuse and specular term from a single texture.", "blinn-phong:kd=0.2/0.22/0.28,ks=0.5,n=60"),
            figure3("banks-circular", "disk-sphere-circular", "Circular grooves: Banks",
                    "The tangent runs around the axis; one texture of (t·l, t·v).", banks),
            figure3("banks-radial", "disk-sphere-radial", "Radial grooves: Banks",
                    "The same texture; the tangent runs away from the axis.", banks),
            figure3("ggx-circular", "disk-sphere-circular", "Circular grooves: brushed silver, anisotropic GGX",
                    "Slope widths 0.08 along the tangent and 0.4 across.", ggx),
            figure3("ward-radial", "disk-sphere-radial", "Radial grooves: Ward",
                    "Ward's elliptical Gaussian over a red ground, 0.1 along the tangent and 0.35 across.", ward)};
}

std::vector<Recipe> figure4() {
    std::vector<Recipe> list;
    for (const bool left : {true, false}) {
        Recipe r;
        r.id = left ? "teapot-left" : "teapot-right";
        r.section = kFigure4;
        r.title = left ? "Teapot from the handle's side" : "The same teapot from the spout's side";
        r.caption = left ? "Ridges too small to see run across the line from handle to spout; their two slopes are "
                           "blue and red. A virtual gonioreflectometer measured them, with masking, shadowing and a "
                           "bounce; the result was factored like any measurement."
                         : "Same asset, same textures: only the camera and its lights went around.";
        r.stage = r.id;
        r.source = kRidges;
        r.white = 0.6;
        list.push_back(r);
    }
    return list;
}

struct Fit {
    const char *material, *mesh, *title, *caption;
    double white;
};
constexpr Fit kShownFits[] = {
    {"alum-bronze", "armadillo", "Aluminium bronze", "A metal with a warm, wide highlight.", 0},
    {"red-fabric", "bunny00", "Red fabric", "Hardly a highlight; light gathers towards grazing angles.", 0.22},
    {"gold-metallic-paint", "ChineseDragon-10kv", "Gold metallic paint", "Flakes: a wide, coloured lobe.", 0},
    {"black-phenolic", "lion-head", "Black phenolic", "Dark and polished: the sharpest lobe here.", 0},
    {"blue-metallic-paint", "refined_elephant", "Blue metallic paint", "A coloured lobe over a dark ground.", 0.28},
    {"green-latex", "camel", "Green latex", "Nearly matt, with a soft sheen.", 0.16}};

std::vector<Recipe> publishedFits() {
    std::vector<Recipe> list;
    for (const Fit& fit : kShownFits) {
        Recipe r;
        r.id = std::string("sgd-") + fit.material;
        r.section = kFits;
        r.title = fit.title;
        r.caption = std::string(fit.caption) +
                    " Shifted gamma distribution (Bagher, Soler & Holzschuch 2012), fitted "
                    "to a material of the MERL database.";
        r.stage = std::string("scan:") + fit.mesh;
        r.white = fit.white;
        r.source = std::string("sgd:") + fit.material;
        r.bake.maxBytes = 65536;
        r.bake.maxFetches = 2;
        list.push_back(r);
    }
    return list;
}

std::string lowerId(std::string name) {
    for (char& c : name) c = std::isalnum(static_cast<unsigned char>(c)) ? static_cast<char>(std::tolower(c)) : '-';
    return name;
}

std::vector<Recipe> measuredFiles(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (const auto& item : std::filesystem::directory_iterator(folder, none))
        if (item.path().extension() == ".bsdf" || item.path().extension() == ".binary") files.push_back(item.path());
    std::sort(files.begin(), files.end());
    std::vector<Recipe> list;
    for (std::size_t i = 0; i < files.size(); ++i) {
        const bool rgl = files[i].extension() == ".bsdf";
        Recipe r;
        r.id = (rgl ? "rgl-" : "merl-") + lowerId(files[i].stem().string());
        r.section = kFiles;
        r.title = files[i].stem().string();
        r.caption = rgl ? "Measured by the RGL goniophotometer." : "A table of the MERL format.";
        r.stage = std::string("scan:") + kShownFits[i % std::size(kShownFits)].mesh;
        r.source = files[i].string();
        r.bake.maxBytes = 65536;
        r.bake.maxFetches = 2;
        list.push_back(r);
    }
    return list;
}

void append(std::vector<Recipe>& list, std::vector<Recipe> more) {
    for (Recipe& recipe : more) list.push_back(std::move(recipe));
}

}  // namespace

std::vector<Recipe> galleryRecipes(const std::filesystem::path& brdfFolder) {
    std::vector<Recipe> list = figure2();
    append(list, figure3());
    append(list, figure4());
    append(list, publishedFits());
    append(list, measuredFiles(brdfFolder));
    return list;
}

std::string shellQuoted(const std::string& text) {
    const char* plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
    if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string bakeCommand(const Recipe& recipe) {
    const FactorizeOptions& b = recipe.bake;
    std::string command = fmt::format("nacre factorize {} -o {}.exr", shellQuoted(recipe.source), recipe.id);
    if (b.method != "auto") command += " --method " + b.method;
    if (b.size != 0) command += fmt::format(" --size {}", b.size);
    if (b.terms != 0) command += fmt::format(" --terms {}", b.terms);
    if (!b.parametrization.empty()) command += " --parametrization " + b.parametrization;
    if (b.format != TexelFormat::Half) command += " --format " + toString(b.format);
    if (b.maxError) command += fmt::format(" --max-error {}", *b.maxError);
    if (b.maxBytes) command += fmt::format(" --max-bytes {}", *b.maxBytes);
    if (b.maxFetches) command += fmt::format(" --max-fetches {}", *b.maxFetches);
    return command;
}

}  // namespace nacre
