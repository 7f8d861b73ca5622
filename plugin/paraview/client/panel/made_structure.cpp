#include "plugin/paraview/client/panel/made_structure.h"

#include <vtkPolyData.h>

#include <exception>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "io/fields/filtered.h"
#include "io/quantile.h"
#include "io/structures/outline_places.h"
#include "io/structures/scan_edge.h"
#include "plugin/paraview/common/structure_shapes.h"
#include "plugin/session/shared_distance.h"
#include "plugin/session/shared_edits.h"

namespace palpate::plugin {
namespace {

/// Half of the outline, or more, lies at edges: the upper quartile is one of them.
double steepness_at(const io::DistanceField& outline, const std::shared_ptr<const io::Volume>& scan) {
  constexpr double every_mm = 6, upper = 0.75;
  const auto fields = io::edge_fields(io::raw_of(scan));
  std::vector<double> per_mm;
  for (const io::OutlinePlace& place : io::outline_places(outline, every_mm)) {
    const io::Sample sample = fields->sample(place.place_mm, io::FieldSet::gradient);
    if (sample.inside) per_mm.push_back(glm::length(sample.gradient));
  }
  return per_mm.empty() ? 0 : io::quantile(std::move(per_mm), upper);
}

void draw_structure(const WantedStructure& wanted, MadeStructure& made) {
  constexpr double room_mm = 3;  // the box is of voxel centers
  const auto outline = wanted.outline ? wanted.outline : shared_distance(wanted.structure, wanted.scan->geometry);
  const auto fields = shared_edited(outline, wanted.edits, wanted.scan);
  DrawnStructure& drawn = made.drawn;
  drawn.distance = fields.back();
  drawn.low_mm = made.measures->box_low_mm - room_mm;
  drawn.high_mm = made.measures->box_high_mm + room_mm;
  if (const auto box = io::box_of_edits(wanted.edits)) {
    drawn.before = outline;
    drawn.low_mm = glm::min(drawn.low_mm, box->low_mm);
    drawn.high_mm = glm::max(drawn.high_mm, box->high_mm);
    made.change = io::outline_change(*outline, *drawn.distance, *box);
  }
  drawn.surface = surface_of(*drawn.distance, drawn.low_mm, drawn.high_mm);
  made.edge_per_mm = steepness_at(*outline, wanted.scan);
}

}  // namespace

MadeStructure make_structure(const WantedStructure& wanted) {
  MadeStructure made{.file = wanted.structure.file,
                     .number = wanted.structure.number,
                     .edits = wanted.edits,
                     .error = {},
                     .measures = wanted.measures,
                     .drawn = {},
                     .change = {}};
  try {
    if (!made.measures) made.measures = std::make_shared<const io::StructureMeasures>(io::measure(wanted.structure));
    if (wanted.draws) draw_structure(wanted, made);
  } catch (const std::exception& error) {
    made.error = error.what();
  }
  return made;
}

}  // namespace palpate::plugin
