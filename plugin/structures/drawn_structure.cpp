#include "plugin/structures/drawn_structure.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <memory>
#include <utility>

#include "io/structures/edits.h"

namespace palpate::plugin {
namespace {

class Drawn : public io::StructureSource {
 public:
  explicit Drawn(io::ContoursEdit contours) : contours_(std::move(contours)) {}
  const io::ContoursEdit& contours() const { return contours_; }

  std::shared_ptr<const io::DistanceField> distance(int /*number*/, const io::DistanceOptions& options) const override {
    return io::apply_edit(nullptr, contours_, {.distance = options});
  }

  io::StructureBox box(int /*number*/, const io::RigidMotion& /*motion*/) const override {
    io::StructureBox box{io::Vec3(std::numeric_limits<double>::infinity()),
                         io::Vec3(-std::numeric_limits<double>::infinity())};
    for (const auto& loop : contours_.loops_mm) {
      for (const io::Vec3& place : loop) {
        box.low_mm = glm::min(box.low_mm, place);
        box.high_mm = glm::max(box.high_mm, place);
      }
    }
    return box;
  }

  /// By the distances on a lattice of a millimeter: a place near the edge counts by how far it is inside.
  io::StructureMeasures measure(int number, const io::RigidMotion& motion, const io::Geometry* scan) const override {
    constexpr double step_mm = 1, room_mm = 3;
    io::DistanceOptions options;
    options.scan = scan;
    const auto field = distance(number, options);
    const auto [low, high] = box(number, motion);
    io::StructureMeasures measures;
    measures.contours = contours_.loops_mm.size();
    measures.box_low_mm = low;
    measures.box_high_mm = high;
    io::Vec3 sum(0);
    double inside = 0;
    for (double z = low.z - room_mm; z <= high.z + room_mm; z += step_mm) {
      for (double y = low.y - room_mm; y <= high.y + room_mm; y += step_mm) {
        for (double x = low.x - room_mm; x <= high.x + room_mm; x += step_mm) {
          const double part = std::clamp(0.5 + field->sample({x, y, z}).mm / step_mm, 0.0, 1.0);
          inside += part;
          sum += part * io::Vec3(x, y, z);
        }
      }
    }
    measures.volume_mm3 = inside * step_mm * step_mm * step_mm;
    if (inside > 0) measures.centroid_mm = sum / inside;
    return measures;
  }

 private:
  io::ContoursEdit contours_;
};

}  // namespace

io::Structure drawn_structure(const modes::SceneStructure& named) {
  io::Structure structure;
  structure.kind = io::StructureKind::contours;
  structure.name = named.name;
  structure.color = named.color;
  structure.source = std::make_shared<const Drawn>(std::get<io::ContoursEdit>(named.edits.front()));
  return structure;
}

const io::ContoursEdit* contours_of(const io::Structure& structure) {
  const auto* const drawn = dynamic_cast<const Drawn*>(structure.source.get());
  return drawn ? &drawn->contours() : nullptr;
}

}  // namespace palpate::plugin
