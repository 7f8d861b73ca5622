#include "plugin/paraview/client/panel/structure_finder.h"

#include <utility>

#include "plugin/structures/structure_files.h"
#include "plugin/structures/study_registrations.h"

namespace palpate::plugin {

void StructureFinder::set_scan(std::shared_ptr<const io::Volume> scan) {
  job_.cancel();
  scan_ = std::move(scan);
  looked_into_.clear();
  waiting_.clear();
  next_ = {};
}

void StructureFinder::look_into_asked(const std::vector<std::filesystem::path>& places) {
  next_.asked = !places.empty();
  look_into(places);
}

void StructureFinder::look_into_served(const std::vector<std::filesystem::path>& places, const QString& problem) {
  next_.served = true;
  next_.problem = problem;
  look_into(places);
}

void StructureFinder::look_into(const std::vector<std::filesystem::path>& places) {
  if (!scan_) return;
  for (const std::filesystem::path& place : places) {
    if (looked_into_.insert(place).second) waiting_.push_back(copy_of(place));
  }
  if (waiting_.empty()) return;
  const auto find = [places = waiting_, scan = scan_] {
    io::StructureCatalogue found = io::find_structures(places);
    // Only registrations that a scene will find, so that exactly the listed structures can be felt.
    found.registrations.clear();
    std::set<std::filesystem::path> looked;
    StudyRegistrations study;
    for (io::Structure& structure : found.structures) {
      structure.file = name_of_copy(structure.file);
      if (!looked.insert(structure.file).second) continue;
      for (io::Registration& one : study.beside(structure, *scan)) found.registrations.push_back(std::move(one));
    }
    return found;
  };
  job_.ask(find, [this](const auto& catalogue, const QString& error) {
    if (catalogue) {
      waiting_.clear();
      Found found = std::exchange(next_, {});
      found.catalogue = *catalogue;
      take_(found);
    }
    if (!error.isEmpty()) fail_(error);
  });
}

}  // namespace palpate::plugin
