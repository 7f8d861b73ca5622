#include "plugin/bench/force_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "io/bounding_box.h"
#include "io/errors.h"
#include "io/fields/volume_fields.h"
#include "io/parallel.h"
#include "io/structures/structured_fields.h"
#include "modes/scene/scene_json.h"
#include "modes/scene/starting_scene.h"
#include "modes/scene/suggest.h"
#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

using glm::dvec3;
using glm::ivec3;

constexpr double air_below_hu = -300;

/// A tissue of the truth: all structures with these names together. Strengths are those of suggestions.
struct LabelledTissue {
  const char* name;
  double strength_n;
  std::vector<std::string_view> begins;
};

const std::vector<LabelledTissue>& labelled_tissues() {
  static const std::vector<LabelledTissue> all{
      {"bone",
       modes::defaults::bone_strength_n,
       {"vertebra", "rib", "humerus", "femur", "hip", "sacrum", "sternum", "scapula", "clavicula", "skull", "bone"}},
      {"lung", modes::defaults::skin_strength_n, {"lung"}},
      {"vessel",
       modes::defaults::skin_strength_n,
       {"aorta", "inferior_vena", "portal", "pulmonary", "iliac_artery", "iliac_vena", "superior_vena"}},
      {"organ", modes::defaults::skin_strength_n, {""}}};
  return all;
}

std::size_t tissue_of_name(const std::string& name) {
  const auto& all = labelled_tissues();
  for (std::size_t n = 0; n < all.size(); ++n) {
    for (const std::string_view begins : all[n].begins) {
      if (name.starts_with(begins)) return n;
    }
  }
  return all.size() - 1;
}

std::array<ivec3, 6> neighbors() {
  return {ivec3(1, 0, 0), ivec3(-1, 0, 0), ivec3(0, 1, 0), ivec3(0, -1, 0), ivec3(0, 0, 1), ivec3(0, 0, -1)};
}

bool is_in(const ivec3& at, const ivec3& size) {
  return at.x >= 0 && at.y >= 0 && at.z >= 0 && at.x < size.x && at.y < size.y && at.z < size.z;
}

/// Writes the number into each unnumbered voxel that is reached from these through passable voxels. Returns the count.
std::size_t flood(const io::Mask& lattice, std::vector<ivec3> from, const std::function<bool(const ivec3&)>& may_pass,
                  int number, std::vector<int>& numbers) {
  std::size_t count = from.size();
  for (const ivec3& at : from) numbers[lattice.offset(at.x, at.y, at.z)] = number;
  while (!from.empty()) {
    const ivec3 at = from.back();
    from.pop_back();
    for (const ivec3& way : neighbors()) {
      const ivec3 next = at + way;
      if (!is_in(next, lattice.size)) continue;
      int& there = numbers[lattice.offset(next.x, next.y, next.z)];
      if (there != 0 || !may_pass(next)) continue;
      there = number;
      ++count;
      from.push_back(next);
    }
  }
  return count;
}

void for_voxels(const ivec3& size, const std::function<void(const ivec3&)>& work) {
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) work({i, j, k});
    }
  }
}

/// The masks of the truth, by tissue, and of each structure the tissue and the voxels.
struct Labelled {
  std::vector<io::Mask> tissues;  ///< as labelled_tissues(); a mask without voxels where there is none
  io::Mask body;
  struct Organ {
    std::string name;
    std::size_t tissue = 0;
    std::vector<dvec3> places;  ///< of its voxels
  };
  std::vector<Organ> organs;
};

bool has_voxels(const io::Mask& mask) {
  return std::ranges::any_of(mask.occupancy, [](std::uint8_t part) { return part >= io::Mask::half; });
}

Labelled labelled(const io::Volume& volume, const io::StructureCatalogue& structures) {
  Labelled made;
  made.body = body_in(volume);
  made.tissues.assign(labelled_tissues().size(), empty_mask(volume.geometry));
  for (io::Structure structure : structures.structures) {
    if (!structure.unfit.empty() || !place_on(structure, structures.registrations, volume).why_not.empty()) continue;
    std::shared_ptr<const io::DistanceField> field;
    io::StructureBox box;
    try {
      box = io::box_of(structure);
      field = io::load_distance(structure);
    } catch (const std::runtime_error&) {  // an empty label
      continue;
    }
    Labelled::Organ organ{.name = structure.name, .tissue = tissue_of_name(structure.name), .places = {}};
    io::Mask& mask = made.tissues[organ.tissue];
    dvec3 low = volume.geometry.to_index(box.low_mm), high = volume.geometry.to_index(box.high_mm);
    const ivec3 first = glm::max(ivec3(glm::floor(glm::min(low, high))) - 1, ivec3(0));
    const ivec3 last = glm::min(ivec3(glm::ceil(glm::max(low, high))) + 1, mask.size - 1);
    for (int k = first.z; k <= last.z; ++k) {
      for (int j = first.y; j <= last.y; ++j) {
        for (int i = first.x; i <= last.x; ++i) {
          const dvec3 at = volume.geometry.to_patient(dvec3(i, j, k));
          if (field->sample(at).mm <= 0) continue;  // every voxel's center is on its side of the surface
          mask.occupancy[mask.offset(i, j, k)] = io::Mask::full;
          organ.places.push_back(at);
        }
      }
    }
    if (!organ.places.empty()) made.organs.push_back(std::move(organ));
  }
  return made;
}

/// Throws io::Cancelled if that is wished.
void go_on(const io::Progress& progress) {
  if (progress && !progress(0)) throw io::Cancelled();
}

/// The masks felt: skin first, then the tissues that have voxels.
FeltScene felt_labels(const io::Mask& body, const std::vector<io::Mask>& tissues,
                      const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress) {
  FeltScene felt;
  felt.scene.name = "labels";
  std::vector<const io::Mask*> masks;
  const auto add = [&](const std::string& name, double strength_n, const io::Mask& mask) {
    modes::Mode mode;
    mode.type = "surface";
    mode.name = mode.structure = name;
    mode.strength_of = modes::Datum::distance;
    mode.strength_structure = name;
    mode.strength_n = modes::TransferFunction({{-1, strength_n}, {1, strength_n}});
    felt.scene.modes.push_back(mode);
    felt.scene.structures.push_back({.name = name, .file = name, .segment = name});
    masks.push_back(&mask);
  };
  add("skin", modes::defaults::skin_strength_n, body);
  for (std::size_t n = 0; n < tissues.size(); ++n) {
    if (has_voxels(tissues[n])) add(labelled_tissues()[n].name, labelled_tissues()[n].strength_n, tissues[n]);
  }
  std::vector<std::shared_ptr<const io::DistanceField>> distances(masks.size());
  io::internal::parallel_for(
      masks.size(), [&](std::size_t n) { distances[n] = io::distance_of(*masks[n], {.scan = &volume->geometry}); },
      progress, 0);
  const io::Box box = io::bounding_box(volume->geometry);
  const auto available = io::fields_of(*volume) | io::FieldSet::distance;
  felt.on.plan = std::make_shared<const modes::Plan>(modes::make_plan(
      felt.scene, available, modes::place_workspace(felt.scene.workspace, box.low, box.high, dvec3(0.1))));
  const auto values = std::make_shared<io::VolumeFields>(volume, io::FieldSet::value, 1.0,
                                                         io::FieldOptions{.brick_bytes = 0, .background = false});
  felt.on.source = std::make_shared<io::StructuredFields>(values, std::move(distances));
  felt.on.volume = volume;
  return felt;
}

/// The outlines, changed alike.
ForceRow changed_row(const std::string& name, const std::shared_ptr<const Labelled>& labels,
                     const std::shared_ptr<const io::Volume>& volume,
                     const std::function<io::Mask(const io::Mask&)>& change) {
  return {name, [=](const io::Progress& progress) {
            std::vector<io::Mask> changed;
            for (const io::Mask& mask : labels->tissues) {
              go_on(progress);
              changed.push_back(has_voxels(mask) ? change(mask) : mask);
            }
            return felt_labels(labels->body, changed, volume, progress);
          }};
}

PathWorld world_of(const std::shared_ptr<const Labelled>& labels, const std::shared_ptr<const io::Volume>& volume) {
  const auto inside = [volume](const io::Mask& mask, const dvec3& at) {
    const ivec3 voxel(glm::round(volume->geometry.to_index(at)));
    return mask.inside(voxel.x, voxel.y, voxel.z);
  };
  PathWorld world;
  for (std::size_t n = 0; n < labels->organs.size(); ++n) {
    world.targets.push_back({labels->organs[n].name,
                             [labels, n](std::mt19937_64& random) {
                               const auto& places = labels->organs[n].places;
                               return places[std::uniform_int_distribution<std::size_t>(0, places.size() - 1)(random)];
                             },
                             labels->organs[n].tissue == 0});
  }
  world.is_outside = [=](const dvec3& at) { return !inside(labels->body, at); };
  world.is_bone = [=](const dvec3& at) { return inside(labels->tissues.front(), at); };
  world.is_known = [=](const dvec3& at) { return volume->geometry.contains(volume->geometry.to_index(at)); };
  const io::Box box = io::bounding_box(volume->geometry);
  world.stretch = box.high - box.low;
  return world;
}

std::uint64_t mixed(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

io::Mask grown(const io::Mask& mask) {
  io::Mask made = mask;
  for_voxels(mask.size, [&](const ivec3& at) {
    if (mask.inside(at.x, at.y, at.z)) return;
    for (const ivec3& way : neighbors()) {
      if (way.z == 0 && mask.inside(at.x + way.x, at.y + way.y, at.z)) {
        made.occupancy[made.offset(at.x, at.y, at.z)] = io::Mask::full;
      }
    }
  });
  return made;
}

}  // namespace

io::Mask empty_mask(const io::Geometry& geometry) {
  io::Mask mask;
  mask.geometry = geometry;
  mask.size = geometry.dimensions;
  mask.occupancy.assign(static_cast<std::size_t>(mask.size.x) * static_cast<std::size_t>(mask.size.y) *
                            static_cast<std::size_t>(mask.size.z),
                        0);
  return mask;
}

io::Mask body_in(const io::Volume& volume) {
  io::Mask body = empty_mask(volume.geometry);
  const ivec3 size = body.size;
  const auto is_air = [&](const ivec3& at) {
    return volume.is_padding(at.x, at.y, at.z) || volume.value_at(at.x, at.y, at.z) < air_below_hu;
  };
  // The largest piece that is not air: without the table and objects on it.
  std::vector<int> pieces(body.occupancy.size());
  int number = 0, largest = 0;
  std::size_t most = 0;
  for_voxels(size, [&](const ivec3& at) {
    if (pieces[body.offset(at.x, at.y, at.z)] != 0 || is_air(at)) return;
    const std::size_t count = flood(
        body, {at}, [&](const ivec3& next) { return !is_air(next); }, ++number, pieces);
    if (count > most) {
      most = count;
      largest = number;
    }
  });
  if (most == 0) return body;
  // Floods the room's air from the sides of the slices; enclosed air belongs to the body.
  const auto is_body = [&](const ivec3& at) { return pieces[body.offset(at.x, at.y, at.z)] == largest; };
  std::vector<ivec3> room;
  for_voxels(size, [&](const ivec3& at) {
    const bool is_side = at.x == 0 || at.y == 0 || at.x == size.x - 1 || at.y == size.y - 1;
    if (is_side && !is_body(at)) room.push_back(at);
  });
  std::vector<int> outside(pieces.size());
  flood(
      body, room, [&](const ivec3& next) { return !is_body(next); }, 1, outside);
  for (std::size_t n = 0; n < outside.size(); ++n) body.occupancy[n] = outside[n] != 0 ? 0 : io::Mask::full;
  return body;
}

io::Mask eroded(const io::Mask& mask, int voxels) {
  io::Mask inverse = mask;
  for (std::uint8_t& part : inverse.occupancy) part = part >= io::Mask::half ? 0 : io::Mask::full;
  for (int n = 0; n < voxels; ++n) inverse = grown(inverse);
  for (std::uint8_t& part : inverse.occupancy) part = part >= io::Mask::half ? 0 : io::Mask::full;
  return inverse;
}

io::Mask shifted(const io::Mask& mask, int columns) {
  io::Mask made = mask;
  for_voxels(mask.size, [&](const ivec3& at) {
    made.occupancy[made.offset(at.x, at.y, at.z)] = mask.inside(at.x - columns, at.y, at.z) ? io::Mask::full : 0;
  });
  return made;
}

io::Mask ragged(const io::Mask& mask, int voxels, std::uint64_t seed) {
  const io::Mask less = eroded(mask, voxels);
  io::Mask more = mask;
  for (int n = 0; n < voxels; ++n) more = grown(more);
  io::Mask made = mask;
  for_voxels(mask.size, [&](const ivec3& at) {
    const ivec3 patch = at / 4;
    const std::uint64_t number = (static_cast<std::uint64_t>(patch.z) << 40U) |
                                 (static_cast<std::uint64_t>(patch.y) << 20U) | static_cast<std::uint64_t>(patch.x);
    const io::Mask& of = (mixed(mixed(seed) ^ number) & 1U) != 0 ? less : more;
    made.occupancy[made.offset(at.x, at.y, at.z)] = of.inside(at.x, at.y, at.z) ? io::Mask::full : 0;
  });
  return made;
}

std::vector<ForceGroup> label_groups(const std::shared_ptr<const io::Volume>& volume,
                                     const io::StructureCatalogue& structures, std::uint64_t seed) {
  const auto labels = std::make_shared<const Labelled>(labelled(*volume, structures));
  if (labels->organs.empty()) throw InputRefused(say("no-structure-lies-on-the-scan"));
  ForceGroup scenes{
      .name = scenes_group,
      .against = "its reference labels and skin, with the strength of each tissue",
      .world = world_of(labels, volume),
      .truth =
          [=](const io::Progress& progress) { return felt_labels(labels->body, labels->tissues, volume, progress); },
      .off_mm = {},
      .rows = {}};
  ForceGroup outlines = scenes;
  outlines.name = "outlines";
  scenes.rows = {{"automatic scene (suggest)",
                  [=](const io::Progress& progress) {
                    return felt_on_scan(modes::suggest(volume, progress).scene, volume, progress);
                  }},
                 {"starting scene", [=](const io::Progress& progress) {
                    return felt_on_scan(modes::load_scene(modes::starting_scene(*volume)), volume, progress);
                  }}};
  for (const int voxels : {1, 2}) {
    const std::string by = fmt::format("{} voxel{}", voxels, voxels == 1 ? "" : "s");
    outlines.rows.push_back(changed_row("labels eroded by " + by, labels, volume,
                                        [=](const io::Mask& mask) { return eroded(mask, voxels); }));
    outlines.rows.push_back(changed_row("labels shifted by " + by, labels, volume,
                                        [=](const io::Mask& mask) { return shifted(mask, voxels); }));
    outlines.rows.push_back(changed_row("labels noisy by " + by, labels, volume,
                                        [=](const io::Mask& mask) { return ragged(mask, voxels, seed); }));
  }
  return {scenes, outlines};
}

}  // namespace palpate::plugin
