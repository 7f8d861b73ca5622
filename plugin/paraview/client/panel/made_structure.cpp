#include "plugin/paraview/client/panel/made_structure.h"

#include <vtkPolyData.h>

#include <algorithm>
#include <exception>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "io/quantile.h"
#include "io/structures/outline_places.h"
#include "io/structures/scan_edge.h"
#include "plugin/paraview/common/structure_shapes.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/shared_distance.h"
#include "plugin/structures/shared_edits.h"

namespace palpate::plugin {
namespace {

/// How steep the values are there as a scene feels them: at the upper quartile, since not all of an outline has an
/// edge.
double steepness_at(const std::vector<io::OutlinePlace>& places, const std::shared_ptr<const io::Volume>& scan) {
  constexpr double upper = 0.75;
  const io::VolumeFields fields(scan, io::FieldSet::gradient, io::default_gradient_scale_mm(scan->geometry),
                                {.brick_bytes = 0, .background = false});
  std::vector<double> per_mm;
  for (const io::OutlinePlace& place : places) {
    const io::Sample sample = fields.sample(place.place_mm, io::FieldSet::gradient);
    if (sample.inside) per_mm.push_back(glm::length(sample.gradient));
  }
  return per_mm.empty() ? 0 : io::quantile(std::move(per_mm), upper);
}

/// From about a hundred places of the outline.
OutlineEdges edges_at(const io::DistanceField& outline, const std::shared_ptr<const io::Volume>& scan) {
  constexpr double every_mm = 6, within_mm = 3;
  constexpr std::size_t most_places = 100;
  const std::vector<io::OutlinePlace> places = io::outline_places(outline, every_mm);
  OutlineEdges edges{.per_mm = steepness_at(places, scan)};
  const auto fields = io::edge_fields(scan);
  std::vector<double> rises[2], middles[2];  // those that fall on the way in, and those that rise
  for (std::size_t n = 0; n < places.size(); n += 1 + places.size() / most_places) {
    const auto& [place, inward, area] = places[n];
    const auto edge = io::scan_edge({*fields, scan->geometry}, outline, place, inward, within_mm);
    if (!edge) continue;
    rises[edge->rise > 0].push_back(edge->rise);
    middles[edge->rise > 0].push_back(fields->sample(place + edge->mm * inward, io::FieldSet::value).value);
  }
  const bool up = rises[1].size() >= rises[0].size();
  if (rises[up].empty()) return edges;
  edges.rise = io::quantile(std::move(rises[up]), 0.5);
  edges.middle = io::quantile(std::move(middles[up]), 0.5);
  return edges;
}

void draw_structure(const WantedStructure& wanted, MadeStructure& made) {
  constexpr double room_mm = 3;  // the box is of voxel centers
  const auto outline = wanted.outline ? wanted.outline : shared_distance(wanted.structure, wanted.scan->geometry);
  const std::span<const io::Edit> edits =
      std::span(wanted.edits).subspan(std::min(making_edits(wanted.structure), wanted.edits.size()));
  const auto fields = shared_edited(outline, edits, wanted.scan);
  made.outline = outline;
  DrawnStructure& drawn = made.drawn;
  drawn.distance = fields.back();
  drawn.low_mm = made.measures->box_low_mm - room_mm;
  drawn.high_mm = made.measures->box_high_mm + room_mm;
  if (const auto box = io::box_of_edits(edits)) {
    drawn.before = outline;
    drawn.surface_before =
        wanted.surface_before ? wanted.surface_before : surface_of(*outline, drawn.low_mm, drawn.high_mm);
    drawn.low_mm = glm::min(drawn.low_mm, box->low_mm);
    drawn.high_mm = glm::max(drawn.high_mm, box->high_mm);
    made.change = io::outline_change(*outline, *drawn.distance, *box);
  }
  drawn.surface = surface_of(*drawn.distance, drawn.low_mm, drawn.high_mm);
  made.edges = edges_at(*outline, io::raw_of(wanted.scan));
}

}  // namespace

MadeStructure make_structure(const WantedStructure& wanted) {
  MadeStructure made{.structure = wanted.structure,
                     .scan = wanted.scan,
                     .edits = wanted.edits,
                     .error = {},
                     .measures = wanted.measures,
                     .outline = {},
                     .drawn = {},
                     .change = {},
                     .edges = {}};
  try {
    if (!made.measures)
      made.measures = std::make_shared<const io::StructureMeasures>(
          io::measure(wanted.structure, wanted.scan ? &wanted.scan->geometry : nullptr));
    if (wanted.draws) draw_structure(wanted, made);
  } catch (const std::exception& error) {
    made.error = error.what();
  }
  return made;
}

}  // namespace palpate::plugin
