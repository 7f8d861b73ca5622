#include "io/structures/edits.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/errors.h"
#include "io/messages.h"
#include "io/reach.h"
#include "io/structures/contour_planes.h"
#include "io/structures/edit_changes.h"

namespace palpate::io {
namespace {

void check_places(std::span<const Vec3> places) {
  if (places.empty()) throw InvalidInput(say("edit-has-no-points"));
  if (places.size() > edit_limits::most_points) {
    throw InvalidInput(say("edit-has-many-points", places.size(), edit_limits::most_points));
  }
  for (const Vec3& place : places) {
    if (!std::isfinite(place.x) || !std::isfinite(place.y) || !std::isfinite(place.z)) {
      throw InvalidInput(say("edit-has-no-number"));
    }
    if (glm::length(place) > internal::farthest_place_mm) throw InvalidInput(say("edit-is-far-away"));
  }
}

void check_length(const std::string& what, double mm) {
  if (!(mm >= edit_limits::least_mm && mm <= edit_limits::most_mm)) {
    const auto in_words = [](double number) { return fmt::format("{:g}", number); };
    throw InvalidInput(
        say("edit-length-is-off", what, in_words(mm), in_words(edit_limits::least_mm), in_words(edit_limits::most_mm)));
  }
}

internal::Field applied(const internal::Field& before, const TraceEdit& edit, const EditOptions& options,
                        EditOutcome& outcome) {
  check_places(edit.points_mm);
  check_length("reach_mm", edit.reach_mm);
  if (!edit.known_to_mm.empty() && edit.known_to_mm.size() != edit.points_mm.size()) {
    throw InvalidInput(say("trace-has-other-counts", edit.points_mm.size(), edit.known_to_mm.size()));
  }
  for (const double known : edit.known_to_mm) {
    if (!(known >= 0 && std::isfinite(known))) throw InvalidInput(say("edit-has-no-number"));
  }
  return internal::traced(before, edit, options.threads, outcome);
}

internal::Field applied(const internal::Field& before, const AddEdit& edit, const EditOptions& options,
                        EditOutcome& outcome) {
  check_places(edit.tube.path_mm);
  check_length("radius_mm", edit.tube.radius_mm);
  return internal::joined(before, edit.tube, options.threads, outcome);
}

internal::Field applied(const internal::Field& before, const RemoveEdit& edit, const EditOptions& options,
                        EditOutcome& outcome) {
  check_places(edit.tube.path_mm);
  check_length("radius_mm", edit.tube.radius_mm);
  return internal::cut(before, edit.tube, options.threads, outcome);
}

internal::Field applied(const internal::Field& before, const ScanEdgeEdit& edit, const EditOptions& options,
                        EditOutcome& outcome) {
  check_places(std::array{edit.center_mm});
  check_length("radius_mm", edit.radius_mm);
  check_length("most_mm", edit.most_mm);
  return internal::moved_to_scan_edge(before, edit, options, outcome);
}

internal::Field applied(const internal::Field& before, const ContoursEdit& edit, const EditOptions& options,
                        EditOutcome& outcome) {
  if (before) throw InvalidInput(say("contours-come-first"));
  std::size_t points = 0;
  for (const std::vector<Vec3>& loop : edit.loops_mm) {
    check_places(loop);
    points += loop.size();
  }
  if (edit.loops_mm.empty()) throw InvalidInput(say("edit-has-no-points"));
  if (points > edit_limits::most_points) {
    throw InvalidInput(say("edit-has-many-points", points, edit_limits::most_points));
  }
  outcome.points = points;
  try {
    DistanceOptions distance = options.distance;
    distance.threads = options.threads;
    ContourRule rule;
    if (distance.scan != nullptr) {
      rule.thickness_mm = thickness_of_voxels(*distance.scan, stack_of(edit.loops_mm).axes[2]);
    }
    const ContourStack stack = stack_of(edit.loops_mm, rule);
    return std::make_shared<const DistanceField>(planes_of(stack, distance), distance);
  } catch (const DicomError& error) {
    throw InvalidInput(error.text());
  }
}

}  // namespace

const char* name_of(const Edit& edit) noexcept {
  constexpr std::array names{"trace", "add", "remove", "scan_edge", "contours"};
  static_assert(names.size() == std::variant_size_v<Edit>);
  return names.at(edit.index());
}

std::shared_ptr<const DistanceField> apply_edit(const std::shared_ptr<const DistanceField>& before, const Edit& edit,
                                                const EditOptions& options, EditOutcome* outcome) {
  EditOutcome own;
  try {
    if (!before && !std::holds_alternative<ContoursEdit>(edit)) throw InvalidInput(say("edit-of-nothing"));
    return std::visit(
        [&](const auto& one) { return applied(before, one, options, outcome != nullptr ? *outcome : own); }, edit);
  } catch (const InvalidInput& error) {
    throw InvalidInput(at_place(name_of(edit), error.text()));
  }
}

Edited apply_edits(std::shared_ptr<const DistanceField> before, std::span<const Edit> edits,
                   const EditOptions& options) {
  if (edits.size() > edit_limits::most_edits)
    throw InvalidInput(say("edits-are-many", edits.size(), edit_limits::most_edits));
  Edited edited{.field = std::move(before), .outcomes = {}};
  for (const Edit& edit : edits) {
    edited.outcomes.emplace_back();
    try {
      edited.field = apply_edit(edited.field, edit, options, &edited.outcomes.back());
    } catch (const InvalidInput& error) {
      throw InvalidInput(at_place("edit " + std::to_string(edited.outcomes.size()), error.text()));
    }
  }
  return edited;
}

}  // namespace palpate::io
