#include "bench/materials.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <sstream>

#include "core/error.hpp"
#include "core/file.hpp"
#include "factorize/models/models.hpp"
#include "reference/factored_metrics.hpp"

namespace nacre::bench {

namespace fs = std::filesystem;

namespace {

/// The first `quick` of each list are those of a quick run.
struct Sources {
    Group group;
    std::size_t quick;
    std::vector<std::pair<std::string, std::string>> list;  ///< name, source
};

std::vector<Sources> analyticSources() {
    const std::string beckmann = "torrance-sparrow:d=beckmann,g=smith,alpha=";
    return {{Group::Isotropic,
             3,
             {{"Torrance-Sparrow 0.1", beckmann + "0.1"},
              {"Torrance-Sparrow 0.01", beckmann + "0.01"},
              {"Torrance-Sparrow 0.5", beckmann + "0.5"},
              {"Torrance-Sparrow 0.2", beckmann + "0.2"},
              {"Torrance-Sparrow 0.35", beckmann + "0.35"},
              {"GGX gold 0.2", "ggx:alpha=0.2,f=conductor,eta=0.143/0.375/1.442,k=3.983/2.386/1.603"},
              {"Cook-Torrance 0.3", "cook-torrance:d=gaussian,alpha=0.3,kd=0.2"},
              {"Schlick 0.04", "schlick:r=0.04,f0=0.9/0.7/0.3"}}},
            {Group::SingleLobe,
             2,
             {{"Phong 50", "phong:n=50,ks=0.5,kd=0.3/0.2/0.1"},
              {"Blinn-Phong 200", "blinn-phong:n=200,ks=0.5,kd=0.1/0.2/0.3"},
              {"Cosine lobe 20", "cosine-lobe:n=20,cxy=-0.9,cz=0.95,kd=0.2"}}},
            {Group::Anisotropic,
             4,
             {{"GGX 0.1/0.4", "ggx:alphax=0.1,alphay=0.4"},
              {"Ward 0.1/0.3", "ward:alphax=0.1,alphay=0.3"},
              {"Ashikhmin-Shirley 50/500", "ashikhmin-shirley:nu=50,nv=500,rd=0.3"},
              {"Banks 30", "banks:n=30"},
              {"Ward duer 0.05/0.2", "ward:variant=duer,alphax=0.05,alphay=0.2,kd=0.2"},
              {"Schlick 0.04, p 0.3", "schlick:r=0.04,p=0.3"}}}};
}

std::vector<std::string> split(const std::string& text, const std::string& separators) {
    std::vector<std::string> parts;
    for (std::size_t begin = text.find_first_not_of(separators); begin != std::string::npos;) {
        const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = text.find_first_not_of(separators, end);
    }
    return parts;
}

Sources publishedFits() {
    Sources out{Group::PublishedFits, 2, {}};
    for (const ModelInfo& model : listModels())
        if (model.name == "sgd")
            for (const std::string& name : split(model.parameters.front().range, " |"))
                out.list.emplace_back("SGD " + name, "sgd:" + name);
    return out;
}

fs::path brdfFolder(const MaterialOptions& options) { return options.shared / "data" / "brdf"; }

Sources rglFiles(const MaterialOptions& options) {
    Sources out{Group::RglFiles, 1, {}};
    std::error_code missing;
    for (const fs::directory_entry& file : fs::directory_iterator(brdfFolder(options), missing))
        if (file.path().extension() == ".bsdf")
            out.list.emplace_back("RGL " + file.path().stem().string(), file.path().string());
    std::sort(out.list.begin(), out.list.end());
    return out;
}

std::string quoted(const fs::path& path) {
    std::string out = "'";
    for (const char c : path.string()) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

bool run(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

/// A python3 with numpy, or nothing.
std::string pythonWithNumpy() {
    for (const char* python : {"python3", "/usr/bin/python3"})
        if (run(std::string(python) + " -c 'import numpy'")) return python;
    return {};
}

/// First words of the lines of data/brdf/merl_networks.txt.
std::vector<std::string> networkNames(const fs::path& file) {
    const std::vector<std::uint8_t> bytes = readFile(file, 1 << 24);
    std::istringstream lines(std::string(bytes.begin(), bytes.end()));
    std::vector<std::string> names;
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line[0] != '#') names.push_back(line.substr(0, line.find(' ')));
    return names;
}

/// Tables that lie about, and those the tool can make; the tool's are made when asked for (makeTable).
Sources merlTables(const MaterialOptions& options, std::vector<std::string>& notes) {
    Sources out{Group::MerlTables, 1, {}};
    std::error_code missing;
    for (const fs::directory_entry& file : fs::directory_iterator(brdfFolder(options), missing))
        if (file.path().extension() == ".binary")
            out.list.emplace_back("MERL " + file.path().stem().string(), file.path().string());
    const fs::path networks = brdfFolder(options) / "merl_networks.txt";
    if (!fs::exists(networks, missing)) return out;
    const bool canMake = !pythonWithNumpy().empty();
    if (!canMake) notes.push_back("No python3 with numpy: MERL tables could not be made from the fitted networks.");
    for (const std::string& name : networkNames(networks))
        if (const fs::path table = options.cache / (name + ".binary"); canMake || fs::exists(table, missing))
            out.list.emplace_back("MERL network " + name, table.string());
    std::sort(out.list.begin(), out.list.end());
    return out;
}

void makeTable(const MaterialOptions& options, const Material& material) {
    const fs::path table = material.source;
    if (fs::exists(table)) return;
    report(options.progress, "making " + table.string(), 0);
    fs::create_directories(table.parent_path());
    const fs::path tool = options.shared / "tools" / "merl_from_network.py";
    const std::string command = pythonWithNumpy() + " " + quoted(tool) + " " + quoted(table.stem());
    writeThenRename(table, [&](const fs::path& temporary) {
        if (!run(command + " " + quoted(temporary)))
            throw Error(table.string() + ": expected a table, found that " + command + " failed");
    });
}

bool wanted(const MaterialOptions& options, const std::string& name) {
    return options.only.empty() || std::find(options.only.begin(), options.only.end(), name) != options.only.end();
}

void checkNames(const MaterialOptions& options, const std::vector<Sources>& all) {
    std::vector<std::string> known;
    for (const Sources& group : all)
        for (const auto& [name, source] : group.list) known.push_back(name);
    for (const std::string& name : options.only)
        require(std::find(known.begin(), known.end(), name) != known.end(),
                fmt::format("unknown material '{}'; known: {}", name, fmt::join(known, "; ")));
}

}  // namespace

std::string title(Group group) {
    switch (group) {
        case Group::Isotropic:
            return "Micro-facet models, isotropic";
        case Group::SingleLobe:
            return "Single-lobe models";
        case Group::Anisotropic:
            return "Anisotropic models";
        case Group::PublishedFits:
            return "Published fits of measured materials (SGD)";
        case Group::MerlTables:
            return "MERL-format tables";
        case Group::RglFiles:
            return "RGL measurements";
    }
    return {};
}

MaterialList benchMaterials(const MaterialOptions& options) {
    MaterialList out;
    std::vector<Sources> all = analyticSources();
    all.push_back(publishedFits());
    all.push_back(merlTables(options, out.notes));
    all.push_back(rglFiles(options));
    checkNames(options, all);
    for (const Sources& group : all) {
        if (group.list.empty()) out.notes.push_back(title(group.group) + ": none on this machine.");
        const std::size_t count =
            options.quick && options.only.empty() ? std::min(group.quick, group.list.size()) : group.list.size();
        for (std::size_t i = 0; i < count; ++i)
            if (wanted(options, group.list[i].first))
                out.materials.push_back({group.list[i].first, group.group, group.list[i].second});
    }
    for (const Material& material : out.materials)
        if (material.group == Group::MerlTables) makeTable(options, material);
    return out;
}

OpenMaterial open(const Material& material) {
    const auto start = std::chrono::steady_clock::now();
    OpenMaterial out;
    out.reflectance = openReflectance(material.source);
    out.openSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    out.truth = truthOf(out.reflectance);
    return out;
}

}  // namespace nacre::bench
