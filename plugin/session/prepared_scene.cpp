#include "plugin/session/prepared_scene.h"

#include <algorithm>
#include <utility>

#include "io/bounding_box.h"
#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "io/structures/structured_fields.h"
#include "modes/tick/reach.h"

namespace palpate::plugin {

namespace {

io::FieldSet available_fields(const modes::Scene& scene, const io::Volume& volume) {
  return io::fields_of(volume) | (scene.structures.empty() ? io::FieldSet::none : io::FieldSet::distance);
}

}  // namespace

std::shared_ptr<const modes::Plan> plan_for(const modes::Scene& scene, const io::Volume& volume,
                                            const glm::dvec3& device_half_extent_m) {
  const io::Box box = io::bounding_box(volume.geometry);
  modes::Plan plan = modes::make_plan(scene, available_fields(scene, volume),
                                      modes::place_workspace(scene.workspace, box.low, box.high, device_half_extent_m));
  modes::leave_out_slices(volume.geometry, device_half_extent_m, plan);
  return std::make_shared<const modes::Plan>(std::move(plan));
}

io::FieldSet scan_fields(const modes::Plan& plan) noexcept {
  return static_cast<io::FieldSet>(static_cast<unsigned>(plan.fields) & ~static_cast<unsigned>(io::FieldSet::distance));
}

namespace {

bool same_distances(const std::vector<LoadedStructure>& a, const std::vector<LoadedStructure>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const LoadedStructure& x, const LoadedStructure& y) { return x.distance == y.distance; });
}

std::shared_ptr<const io::FieldSource> with_structures(std::shared_ptr<const io::FieldSource> scan,
                                                       const std::vector<LoadedStructure>& structures) {
  std::vector<std::shared_ptr<const io::DistanceField>> distances;
  distances.reserve(structures.size());
  for (const LoadedStructure& structure : structures) distances.push_back(structure.distance);
  return std::make_shared<const io::StructuredFields>(std::move(scan), std::move(distances));
}

}  // namespace

PreparedScene prepare(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                      const glm::dvec3& device_half_extent_m, std::span<const RegisteredStructure> recorded) {
  return prepare(scene, volume, device_half_extent_m, Prepared(), recorded);
}

std::vector<RegisteredStructure> registered_of(const PreparedScene& felt) {
  std::vector<RegisteredStructure> registered;
  for (const LoadedStructure& structure : felt.structures) {
    if (structure.registered) registered.push_back(*structure.registered);
  }
  return registered;
}

PreparedScene prepare(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                      const glm::dvec3& device_half_extent_m, const Prepared& before,
                      std::span<const RegisteredStructure> recorded) {
  const std::shared_ptr<const io::Volume>& ahead = before.felt.volume;
  const bool of_scan = ahead && io::raw_of(ahead) == io::raw_of(volume);
  const bool is_ready = of_scan && io::filter_of(*ahead) == scene.filter;
  PreparedScene felt{.plan = plan_for(scene, *volume, device_half_extent_m),
                     .source = nullptr,
                     .volume = is_ready ? ahead : io::filtered(volume, scene.filter)};
  const bool same_scan = before.felt.source && is_ready && before.felt.plan->fields == felt.plan->fields &&
                         before.felt.plan->slices == felt.plan->slices &&
                         before.scene.gradient_scale_mm == scene.gradient_scale_mm &&
                         before.scene.sampling == scene.sampling;
  std::vector<LoadedStructure> known = before.read_ahead;
  if (ahead) {
    const std::vector<LoadedStructure> felt_before =
        of_scan ? before.felt.structures : carried_over(before.felt.structures, *ahead, *volume);
    known.insert(known.end(), felt_before.begin(), felt_before.end());
  }
  felt.structures = load_structures(scene, *felt.plan, volume, known, recorded);
  if (same_scan && same_distances(felt.structures, before.felt.structures)) {
    felt.source = before.felt.source;
    return felt;
  }
  std::shared_ptr<const io::FieldSource> scan;
  if (const auto* structured = dynamic_cast<const io::StructuredFields*>(before.felt.source.get());
      same_scan && structured != nullptr) {
    scan = structured->scan();
  } else {
    io::FieldOptions options = modes::field_options(scene.sampling);
    options.ahead = felt.plan->slices;
    scan = std::make_shared<const io::VolumeFields>(
        felt.volume, scan_fields(*felt.plan),
        scene.gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry)), options);
  }
  felt.source = felt.structures.empty() ? scan : with_structures(scan, felt.structures);
  return felt;
}

}  // namespace palpate::plugin
