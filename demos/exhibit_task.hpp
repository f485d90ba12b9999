// What the makers of exhibits share.
#pragma once

#include "demos/exhibit_builder.hpp"
#include "demos/exhibit_list.hpp"
#include "demos/relief.hpp"
#include "demos/surrounding.hpp"

namespace nacre {

/// One exhibit to be made.
struct Task {
    ProgramLoader& loader;
    const ExhibitOptions& options;
    std::vector<std::string>& notes;
    std::string id;

    int size(int full) const { return options.quick ? full / 2 : full; }
    BuilderOptions builder() const { return {options.timingRepeats, options.progress}; }
    Surrounding open(const std::string& name) const;                        ///< notes what stands in
    ReliefSource openHeights(const std::string& name, double scale) const;  ///< the same
};

/// The truth's samples, before the surrounding as it came.
std::vector<Rgb> shade(const Body& body, const SurroundedSurface& surface, const EnvMap& sky);

/// `nacre envmap` commands that make the exhibit's maps: the surrounding into a cube of the size that the filters start
/// from, and from that one each of `filters` ("OUT.exr --lobe …"). Empty for a made-up sky.
std::vector<std::string> envmapCommands(const Surrounding& s, int coarseSize, const std::vector<std::string>& filters);

struct NamedExhibit {
    const char* id;
    Exhibit (*make)(const Task&);
};
const std::vector<NamedExhibit>& environmentExhibits();
const std::vector<NamedExhibit>& bumpExhibits();
const std::vector<NamedExhibit>& sceneExhibits();
const std::vector<NamedExhibit>& specularExhibits();
const std::vector<NamedExhibit>& lightPathExhibits();
const std::vector<NamedExhibit>& transferExhibits();
const std::vector<NamedExhibit>& multipassExhibits();
const std::vector<NamedExhibit>& hybridExhibits();

/// multipass_tables.cpp
Exhibit multipassTables(const Task& task);

/// shadow_exhibits.cpp
Exhibit shadowStudyExhibit(const Task& task);

/// transfer_gloss_exhibit.cpp
Exhibit transferGlossExhibit(const Task& task);
/// transfer_objects_exhibit.cpp
Exhibit transferObjectsExhibit(const Task& task);

/// room_exhibit.cpp
Exhibit roomsExhibit(const Task& task);

/// pipes_exhibit.cpp
Exhibit pipesExhibit(const Task& task);

/// counted_shadow_exhibits.cpp
Exhibit countedShadowsExhibit(const Task& task);
Exhibit softCountedExhibit(const Task& task);
/// The share of a scene's first lamp that each pixel sees, as grey: of 16 points by counted volumes, smoothed, and of
/// 1024 by rays. \param scene  its first light has an area
struct ShadowStage {
    Image drawn, truth;
};
ShadowStage shadowStage(ProgramLoader& loader, const SceneDescription& scene, int width, int height);

/// environment_sweeps.cpp
Exhibit ggxSweepExhibit(const Task& task);
Exhibit sunExhibit(const Task& task);
Exhibit lampsExhibit(const Task& task);

}  // namespace nacre
