#include "plugin/app/open_scan.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <glm/geometric.hpp>
#include <utility>

#include "io/fields/filtered.h"
#include "io/load.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/starting_scene.h"
#include "plugin/messages/tell.h"
#include "solver/text/printable.h"

namespace palpate::plugin {

io::Volume open_scan(const io::Series& series, int frame) {
  return open_scan(series, frame, terminal_progress("reading slices"));
}

io::Volume open_scan(const io::Series& series, int frame, const io::Progress& progress) {
  io::Volume volume = io::load(series, {.frame = frame, .progress = progress, .is_rescaled = true});
  const auto show = [](const std::string& warning) {
    std::fprintf(stderr, "palpate: warning: %s\n", printable(warning).c_str());
  };
  std::for_each(series.warnings.begin(), series.warnings.end(), show);
  std::for_each(volume.warnings.begin(), volume.warnings.end(), show);
  return volume;
}

modes::Scene scene_for(const std::string& file_or_name, const io::Volume& volume) {
  return modes::load_scene(file_or_name.empty() ? modes::starting_scene(volume) : file_or_name);
}

std::string describe_scan(const io::Volume& volume) {
  const io::Geometry& geometry = volume.geometry;
  const io::Filter filter = io::filter_of(volume);
  return fmt::format("{}, {} x {} x {} voxels of {:.3g} x {:.3g} x {:.3g} mm{}", volume.modality, geometry.dimensions.x,
                     geometry.dimensions.y, geometry.dimensions.z, geometry.spacing_i, geometry.spacing_j,
                     glm::length(geometry.step), filter.type == nullptr ? "" : ", " + io::in_words(filter));
}

void warn_of_structures(const PreparedScene& felt) {
  for (const LoadedStructure& structure : felt.structures) {
    for (const Text& warning : structure.warnings) tell(at_place("palpate: warning", warning));
  }
}

io::Progress terminal_progress(std::string what) {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [what = std::move(what), shown = -1](double done) mutable {
    const int percent = static_cast<int>(100 * done);
    if (percent != shown)
      std::fprintf(stderr, "\r%s %3d %%%s", what.c_str(), percent, percent == 100 ? "\r\033[K" : "");
    shown = percent;
    return true;
  };
}

}  // namespace palpate::plugin
