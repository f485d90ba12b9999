// nacre_gallery: bakes, renders and measures every entry and writes the page.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <thread>

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/version.hpp"
#include "demos/entry.hpp"
#include "demos/exhibit_list.hpp"
#include "demos/recipe.hpp"
#include "demos/stage.hpp"
#include "shading/context.hpp"

namespace nacre {
namespace {

struct Arguments {
    std::string out = "build/gallery", data = "build/data", brdf;
    std::vector<std::string> entries;
    bool quick = false, list = false, quiet = false;
};

/// Where a developer's machine keeps measured tables: $NACRE_SHARED, else ../shared beside the working folder.
std::string defaultBrdfFolder() {
    const char* shared = std::getenv("NACRE_SHARED");
    return std::string(shared != nullptr ? shared : "../shared") + "/data/brdf";
}

std::string machineWords() {
    std::ifstream cpu("/proc/cpuinfo");
    std::string model = "unknown processor";
    for (std::string line; std::getline(cpu, line);)
        if (line.rfind("model name", 0) == 0 && line.find(": ") != std::string::npos) {
            model = line.substr(line.find(": ") + 2);
            break;
        }
    return fmt::format("{}, {} cores", model, std::thread::hardware_concurrency());
}

class Reporter {
public:
    Reporter(bool quiet, std::size_t count) : quiet_(quiet), count_(count) {}
    void begin(std::size_t index) { index_ = index; }
    /// One line that overwrites itself on a terminal, one line a step elsewhere.
    void operator()(const std::string& what) const {
        if (quiet_) return;
        const bool terminal = isatty(2) != 0;
        fmt::print(stderr, "{}gallery {}/{}: {}{}", terminal ? "\r\033[K" : "", index_ + 1, count_, what,
                   terminal ? "" : "\n");
        std::fflush(stderr);
    }
    void end() const {
        if (!quiet_ && isatty(2) != 0) fmt::print(stderr, "\r\033[K");
    }

private:
    bool quiet_;
    std::size_t count_, index_ = 0;
};

/// What the command line asks for; everything when it names nothing.
struct Choice {
    std::vector<Recipe> recipes;
    std::vector<std::string> exhibits;
};

Choice chosen(std::vector<Recipe> all, const std::vector<std::string>& ids) {
    const std::vector<std::string> exhibits = exhibitIds();
    if (ids.empty()) return {std::move(all), exhibits};
    std::vector<std::string> known;
    for (const Recipe& r : all) known.push_back(r.id);
    known.insert(known.end(), exhibits.begin(), exhibits.end());
    Choice list;
    for (const std::string& id : ids) {
        const auto at = std::find_if(all.begin(), all.end(), [&](const Recipe& r) { return r.id == id; });
        if (at != all.end()) {
            list.recipes.push_back(*at);
            continue;
        }
        require(std::find(exhibits.begin(), exhibits.end(), id) != exhibits.end(),
                fmt::format("unknown entry '{}'; known: {}", id, fmt::join(known, ", ")));
        list.exhibits.push_back(id);
    }
    return list;
}

void writePictures(const Gallery& gallery, const std::filesystem::path& folder) {
    const auto write = [&](const Picture& picture) {
        writeFile(folder / picture.file,
                  std::string_view(reinterpret_cast<const char*>(picture.png.data()), picture.png.size()));
    };
    for (const Entry& entry : gallery.entries) {
        write(entry.reference);
        for (const Shot& shot : entry.shots) write(shot.picture), write(shot.difference);
    }
    for (const Exhibit& exhibit : gallery.exhibits)
        for (const Picture* picture : picturesOf(exhibit)) write(*picture);
}

Gallery makeGallery(const Arguments& arguments, const Choice& choice) {
    const auto start = std::chrono::steady_clock::now();
    const Context context;
    ProgramLoader loader;
    Gallery gallery;
    gallery.version = nacreVersion();
    gallery.renderer = context.description();
    gallery.machine = machineWords();
    gallery.quick = arguments.quick;
    const std::vector<Recipe>& recipes = choice.recipes;
    Reporter reporter(arguments.quiet, recipes.size() + choice.exhibits.size());
    BakedCache baked;
    EntryOptions options;
    options.folder = arguments.out;
    if (arguments.quick) options.size = 192, options.samples = 20000, options.timingRepeats = 3;
    options.progress = [&](const std::string& what, double) { reporter(what); };
    for (std::size_t i = 0; i < recipes.size(); ++i) {
        reporter.begin(i);
        const Stage stage = openStage(recipes[i].stage, std::filesystem::path(arguments.data) / "meshes");
        if (!stage.note.empty()) gallery.notes.push_back(recipes[i].id + ": " + stage.note);
        gallery.entries.push_back(makeEntry(recipes[i], stage, loader, baked, options));
    }
    ExhibitOptions exhibitOptions;
    exhibitOptions.worldFolder = std::filesystem::path(arguments.data) / "world";
    exhibitOptions.heightFolder = std::filesystem::path(arguments.data) / "heights";
    exhibitOptions.meshFolder = std::filesystem::path(arguments.data) / "meshes";
    exhibitOptions.volumeFolder = std::filesystem::path(arguments.data) / "volumes";
    exhibitOptions.animatedFolder = std::filesystem::path(arguments.data) / "animated";
    exhibitOptions.sceneFolder = NACRE_SCENES;
    exhibitOptions.quick = arguments.quick;
    exhibitOptions.timingRepeats = options.timingRepeats;
    exhibitOptions.progress = options.progress;
    for (std::size_t i = 0; i < choice.exhibits.size(); ++i) {
        reporter.begin(recipes.size() + i);
        gallery.exhibits.push_back(makeExhibit(choice.exhibits[i], loader, exhibitOptions, gallery.notes));
    }
    reporter.end();
    gallery.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return gallery;
}

int run(const Arguments& arguments) {
    const std::filesystem::path out = arguments.out;
    const Choice choice = chosen(galleryRecipes(arguments.brdf), arguments.entries);
    if (arguments.list) {
        for (const Recipe& r : choice.recipes) fmt::print("{}\t{}\n", r.id, bakeCommand(r));
        for (const std::string& id : choice.exhibits) fmt::print("{}\tan exhibit: its page has its commands\n", id);
        return 0;
    }
    std::error_code failed;
    std::filesystem::create_directories(out, failed);
    if (failed) throw Error(out.string() + ": expected a folder to write to, found: " + failed.message());
    const Gallery gallery = makeGallery(arguments, choice);
    writePictures(gallery, out);
    writeFile(out / "gallery.json", galleryJson(gallery).dump(2) + "\n");
    writeFile(out / "index.html", galleryPage(gallery));
    if (!arguments.quiet)
        fmt::print(stderr, "gallery: {} entries in {:.0f} s: {}\n", gallery.entries.size() + gallery.exhibits.size(),
                   gallery.seconds, (out / "index.html").string());
    return 0;
}

}  // namespace
}  // namespace nacre

int main(int argc, char** argv) {
    nacre::Arguments arguments;
    arguments.brdf = nacre::defaultBrdfFolder();
    CLI::App app("Bakes, renders and measures the gallery; writes index.html, gallery.json, pictures and assets.");
    app.add_option("--out", arguments.out, "folder to write")->capture_default_str();
    app.add_option("--data", arguments.data, "folder that demos/fetch.sh filled")->capture_default_str();
    app.add_option("--brdf", arguments.brdf, "folder with measured .bsdf and .binary files")->capture_default_str();
    app.add_option("--entry", arguments.entries, "only this entry (repeatable)");
    app.add_flag("--quick", arguments.quick, "small pictures, few samples");
    app.add_flag("--list", arguments.list, "print the entries and the commands that bake them");
    app.add_flag("--quiet", arguments.quiet, "no progress");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        return nacre::run(arguments);
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "nacre_gallery: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "nacre_gallery: {}\n", error.what());
        return 1;
    }
}
