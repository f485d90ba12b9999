#include "demos/exhibit_list.hpp"

#include "demos/exhibit_task.hpp"

namespace nacre {

static std::vector<NamedExhibit> allExhibits() {
    std::vector<NamedExhibit> out = environmentExhibits();
    out.insert(out.end(), bumpExhibits().begin(), bumpExhibits().end());
    out.insert(out.end(), sceneExhibits().begin(), sceneExhibits().end());
    out.insert(out.end(), specularExhibits().begin(), specularExhibits().end());
    out.insert(out.end(), lightPathExhibits().begin(), lightPathExhibits().end());
    out.insert(out.end(), multipassExhibits().begin(), multipassExhibits().end());
    out.insert(out.end(), hybridExhibits().begin(), hybridExhibits().end());
    out.insert(out.end(), transferExhibits().begin(), transferExhibits().end());
    return out;
}

std::vector<std::string> exhibitIds() {
    std::vector<std::string> out;
    for (const NamedExhibit& n : allExhibits()) out.emplace_back(n.id);
    return out;
}

Exhibit makeExhibit(const std::string& id, ProgramLoader& loader, const ExhibitOptions& options,
                    std::vector<std::string>& notes) {
    for (const NamedExhibit& n : allExhibits())
        if (id == n.id) return n.make({loader, options, notes, id});
    throw std::invalid_argument("unknown exhibit '" + id + "'");
}

}  // namespace nacre
