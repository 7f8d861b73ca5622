#include "plugin/bench/edit_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <memory>
#include <vector>

#include "io/structures/edits.h"
#include "io/structures/label_image.h"
#include "io/structures/structure.h"

namespace palpate::plugin {
namespace {

constexpr double edited_ball_mm = 34, half_width_mm = 44;

std::shared_ptr<const io::DistanceField> ball_of_voxels() {
  io::Mask mask;
  mask.geometry.dimensions = glm::ivec3(static_cast<int>(2 * half_width_mm));
  for (int k = 0; k < mask.geometry.dimensions.z; ++k) {
    mask.geometry.slice_positions.push_back(glm::dvec3(-half_width_mm, -half_width_mm, k - half_width_mm) + 0.5);
  }
  mask.size = mask.geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const bool inside = glm::length(mask.geometry.to_patient(glm::dvec3(i, j, k))) < edited_ball_mm;
        mask.occupancy.push_back(inside ? io::Mask::full : 0);
      }
    }
  }
  return io::distance_of(mask);
}

/// Along a wavy ring 1.5 mm outside the ball.
io::TraceEdit wavy_ring(int points) {
  io::TraceEdit trace;
  for (int n = 0; n < points; ++n) {
    const double turn = 2 * glm::pi<double>() * 0.94 * n / points;
    trace.points_mm.push_back((edited_ball_mm + 1.5) *
                              glm::dvec3(std::cos(turn), std::sin(turn), 0.1 * std::sin(3 * turn)));
  }
  return trace;
}

struct EditCost {
  double wall_ms = 1e300, processor_ms = 1e300;
};

EditCost cost_of_edit(const std::shared_ptr<const io::DistanceField>& field, const io::Edit& edit, int rounds) {
  EditCost best;
  for (int round = 0; round < rounds; ++round) {
    const auto from = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    io::apply_edit(field, edit);
    const double used = 1e3 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - from;
    best.wall_ms = std::min(best.wall_ms, wall.count());
    best.processor_ms = std::min(best.processor_ms, used);
  }
  return best;
}

}  // namespace

std::string tabulate_edit_costs(int rounds) {
  const auto field = ball_of_voxels();
  std::string csv = "edit,wall_ms,processor_ms\n";
  fmt::print(
      "What an edit costs on a ball of {:.0f} mm, voxels of 1 mm: the best of {} rounds\n\n{:30} {:>10} {:>14}\n",
      edited_ball_mm, rounds, "edit", "ms", "processor ms");
  const auto row = [&](const char* what, const io::Edit& edit) {
    const EditCost cost = cost_of_edit(field, edit, rounds);
    fmt::print("{:30} {:10.0f} {:14.0f}\n", what, cost.wall_ms, cost.processor_ms);
    csv += fmt::format("{},{},{}\n", what, cost.wall_ms, cost.processor_ms);
  };
  row("trace of 20 points", [] {
    io::TraceEdit trace = wavy_ring(200);
    trace.points_mm.resize(20);
    return trace;
  }());
  row("trace of 200 points", wavy_ring(200));
  const io::Tube tube{.path_mm = {{edited_ball_mm - 4, 0, 0}, {edited_ball_mm, 8, 0}, {edited_ball_mm - 2, 16, 0}},
                      .radius_mm = 4};
  row("add along 18 mm", io::AddEdit{tube});
  row("remove along 18 mm", io::RemoveEdit{tube});
  return csv;
}

}  // namespace palpate::plugin
