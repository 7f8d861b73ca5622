#include "plugin/structures/shared_distance.h"

#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "io/structures/edits.h"
#include "plugin/structures/drawn_structure.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin {

bool same_place(const io::Geometry& a, const io::Geometry& b) noexcept {
  const auto of = [](const io::Geometry& g) {
    return std::tie(g.dimensions, g.direction_i, g.direction_j, g.spacing_i, g.spacing_j, g.slice_positions);
  };
  return of(a) == of(b);
}

namespace {

struct Kept {
  std::string file;
  std::optional<FileState> state;
  int number = 0;
  io::RigidMotion motion;
  io::Geometry scan;
  std::weak_ptr<const io::DistanceField> distance;
};

/// Of contours that are part of a scene.
struct KeptDrawn {
  io::ContoursEdit contours;
  io::Geometry scan;
  std::weak_ptr<const io::DistanceField> distance;
};

std::mutex mutex;
std::vector<Kept> kept;
std::vector<KeptDrawn> kept_drawn;

std::shared_ptr<const io::DistanceField> find_drawn(const io::ContoursEdit& contours, const io::Geometry& scan,
                                                    double reach_mm) {
  std::erase_if(kept_drawn, [](const KeptDrawn& one) { return one.distance.expired(); });
  for (const KeptDrawn& one : kept_drawn) {
    auto distance = one.distance.lock();
    if (distance && distance->reach_mm() == reach_mm && one.contours == contours && same_place(one.scan, scan)) {
      return distance;
    }
  }
  return nullptr;
}

template <typename Fits>
std::shared_ptr<const io::DistanceField> find(const io::Structure& structure, const std::optional<FileState>& state,
                                              const io::Geometry& scan, const Fits& fits) {
  std::erase_if(kept, [](const Kept& one) { return one.distance.expired(); });
  for (const Kept& one : kept) {
    if (one.file != structure.file.string() || one.state != state || one.number != structure.number ||
        one.motion != structure.motion) {
      continue;
    }
    auto distance = one.distance.lock();
    if (distance && same_place(one.scan, scan) && fits(*distance)) return distance;
  }
  return nullptr;
}

template <typename Fits>
std::shared_ptr<const io::DistanceField> find_or_make(const io::Structure& structure, const io::Geometry& scan,
                                                      double reach_mm, const Fits& fits) {
  const std::optional<FileState> state = state_of_file(copy_of(structure.file));
  {
    const std::lock_guard lock(mutex);
    if (auto found = find(structure, state, scan, fits)) return found;
  }
  io::DistanceOptions options;
  options.reach_mm = reach_mm;
  options.scan = &scan;
  auto made = io::load_distance(structure, options);
  const std::lock_guard lock(mutex);
  if (auto found = find(structure, state, scan, fits)) return found;  // another thread made it meanwhile
  kept.push_back({structure.file.string(), state, structure.number, structure.motion, scan, made});
  return made;
}

}  // namespace

std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan,
                                                         double reach_mm) {
  if (const auto* const contours = contours_of(structure)) return shared_distance(*contours, scan, reach_mm);
  return find_or_make(structure, scan, reach_mm,
                      [&](const io::DistanceField& field) { return field.reach_mm() == reach_mm; });
}

std::shared_ptr<const io::DistanceField> shared_distance(const io::Structure& structure, const io::Geometry& scan) {
  constexpr double least_mm = 3;
  if (const auto* const contours = contours_of(structure)) return shared_distance(*contours, scan, least_mm);
  return find_or_make(structure, scan, least_mm, [](const io::DistanceField&) { return true; });
}

std::shared_ptr<const io::DistanceField> shared_distance(const io::ContoursEdit& contours, const io::Geometry& scan,
                                                         double reach_mm) {
  {
    const std::lock_guard lock(mutex);
    if (auto found = find_drawn(contours, scan, reach_mm)) return found;
  }
  io::EditOptions options;
  options.distance.reach_mm = reach_mm;
  options.distance.scan = &scan;
  auto made = io::apply_edit(nullptr, contours, options);
  const std::lock_guard lock(mutex);
  if (auto found = find_drawn(contours, scan, reach_mm)) return found;  // another thread made it meanwhile
  kept_drawn.push_back({contours, scan, made});
  return made;
}

}  // namespace palpate::plugin
