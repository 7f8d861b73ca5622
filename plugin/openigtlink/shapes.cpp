#include "plugin/openigtlink/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/errors.h"
#include "io/structures/label_image.h"
#include "modes/scene/met_values.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/isosurface.h"
#include "plugin/openigtlink/message.h"
#include "plugin/openigtlink/surface.h"

namespace palpate::plugin::igtl {
namespace {

constexpr double least_part = 0.05;  // of a boundary's strength: less is not sent

void check_shapes_wanted(const io::Progress& progress) {
  if (progress && !progress(0)) throw io::Cancelled();
}

/// Shortened to the length of a device's name, at the end of a character, and made unique by a number.
std::string free_name(const std::vector<Shape>& shapes, const char* type, std::string name) {
  const auto cut = [](std::string text, std::size_t room) {
    if (text.size() <= room) return text;
    while (room > 0 && (static_cast<unsigned char>(text[room]) & 0xC0U) == 0x80U) --room;
    return text.substr(0, room);
  };
  name = cut(name, device_size);
  const auto taken = [&](const std::string& one) {
    return std::ranges::any_of(shapes, [&](const Shape& shape) { return shape.type == type && shape.name == one; });
  };
  std::string free = name;
  for (int n = 2; taken(free); ++n) {
    const std::string number = fmt::format(" {}", n);
    free = cut(name, device_size - number.size()) + number;
  }
  return free;
}

void add_surface(std::vector<Shape>& shapes, const std::string& name, Surface surface) {
  for (glm::dvec3& point : surface.points) point = ras_of(point);
  shapes.push_back({.type = "POLYDATA", .name = free_name(shapes, "POLYDATA", name), .content = content_of(surface)});
}

/// The extent of a field's lattice: the structure and its surroundings.
io::StructureBox box_of(const io::DistanceField& field) {
  const io::NodeLattice& lattice = field.parts().near.lattice;
  const io::Vec3 last(io::NodeBricks::edge * lattice.bricks);
  io::StructureBox box{.low_mm = lattice.origin, .high_mm = lattice.origin};
  for (unsigned corner = 1; corner < 8; ++corner) {
    const io::Vec3 at = lattice.position(last * io::Vec3(corner & 1U, corner >> 1U & 1U, corner >> 2U));
    box.low_mm = glm::min(box.low_mm, at);
    box.high_mm = glm::max(box.high_mm, at);
  }
  return box;
}

void add_labels(std::vector<Shape>& shapes, const std::string& name, const io::DistanceField& field,
                const io::Geometry& scan, const io::Progress& progress) {
  if (!scan.uniform) return;
  const io::LabelImage labels = io::sample_labels(
      {.name = name}, scan, [&](const io::Vec3& at) { return field.sample(at).mm; }, box_of(field), progress);
  const Image image{.number = Image::Number::u8,
                    .size = scan.dimensions,
                    .along = {scan.spacing_i * scan.direction_i, scan.spacing_j * scan.direction_j, scan.step},
                    .first = scan.slice_positions.front(),
                    .voxels = labels.inside};
  shapes.push_back({.type = "IMAGE", .name = free_name(shapes, "IMAGE", name), .content = content_of(image)});
}

/// Without the triangles at which a boundary has no strength: the gradient is too small there, or the tissues are
/// others. Its points are near where the value is met; what else is read changes little on the way there.
void keep_felt(Surface& surface, double value, const modes::Strength& strength, const io::FieldSource& source) {
  if (strength.most_n() <= 0 || !contains(source.available(), strength.reads())) return;
  std::vector<bool> felt;
  for (const glm::dvec3& point : surface.points) {
    io::Sample sample = source.sample(point, strength.reads());
    sample.value = value;
    felt.push_back(sample.inside && strength(sample) > least_part * strength.most_n());
  }
  std::erase_if(surface.triangles, [&](const auto& corners) {
    return std::ranges::any_of(corners, [&](std::uint32_t n) { return !felt[n]; });
  });
}

void append_surface(Surface& surface, const Surface& more) {
  const auto first = static_cast<std::uint32_t>(surface.points.size());
  surface.points.insert(surface.points.end(), more.points.begin(), more.points.end());
  for (const auto& [a, b, c] : more.triangles) surface.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

std::vector<Shape> shapes_of(const PreparedScene& felt, const modes::Scene& scene, const io::Progress& progress) {
  std::vector<Shape> shapes;
  if (!felt.plan || !felt.volume) return shapes;
  for (std::size_t n = 0; n < felt.structures.size(); ++n) {
    const io::DistanceField& field = *felt.structures[n].distance;
    const auto distance = [&](const glm::dvec3& place) {
      check_shapes_wanted(progress);
      const io::Distance there = field.sample(place);
      return SurfaceDistance{there.mm, there.gradient};
    };
    const std::string& name = scene.structures[felt.plan->structures[n]].name;
    add_surface(shapes, name, isosurface(distance, bounding_box(felt.volume->geometry)));
    if (!felt.structures[n].edits.empty()) add_labels(shapes, name, field, felt.volume->geometry, progress);
  }
  for (const modes::ActiveMode& active : felt.plan->modes) {
    if (!active.holds || active.scene_index >= scene.modes.size()) continue;
    const modes::Mode& mode = scene.modes[active.scene_index];
    Surface surface;
    for (const double value : modes::met_values(mode, active.side)) {
      check_shapes_wanted(progress);
      Surface met = isosurface(*felt.volume, value);
      check_shapes_wanted(progress);
      keep_felt(met, value, active.strength, *felt.source);
      append_surface(surface, met);
    }
    if (!surface.triangles.empty()) add_surface(shapes, mode.name.empty() ? mode.type : mode.name, std::move(surface));
  }
  return shapes;
}

}  // namespace palpate::plugin::igtl
