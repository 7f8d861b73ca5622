#include "plugin/bench/scan_edge_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "io/structures/scan_edge.h"
#include "plugin/bench/ball_rays.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

constexpr double inside_hu = 60, outside_hu = -100;  // an organ in fat
constexpr double scanner_mm = 0.6;                   // standard deviation of the scanner's blur
constexpr int rays_of_ball = 2000;

struct Ball {
  double radius = 0, slices_mm = 1, noise_hu = 0;
  glm::dvec3 center{0};
};

std::shared_ptr<const io::Volume> scan_of_ball(const Ball& ball) {
  const double room = 2 * (ball.radius + 3 * ball.slices_mm + 9);
  const testdata::Grid grid{.size = glm::ivec3(glm::ceil(room / glm::dvec3(1, 1, ball.slices_mm))),
                            .spacing = {1, 1, ball.slices_mm}};
  const testdata::Phantom phantom{.background = outside_hu,
                                  .bodies = {{testdata::Ball{ball.center, ball.radius}, inside_hu}}};
  const auto sharp =
      std::make_shared<const io::Volume>(testdata::scan(phantom, testdata::make_geometry(grid), {.quantised = false}));
  io::Volume volume = *io::filtered(sharp, {.type = io::find_filter_type("gaussian"), .sigma_mm = scanner_mm});
  volume.filtered_from = nullptr;
  std::mt19937 random(1);
  std::normal_distribution<float> normal(0, 1);
  for (float& value : std::get<std::vector<float>>(volume.voxels)) {
    value += static_cast<float>(ball.noise_hu) * normal(random);
  }
  return std::make_shared<const io::Volume>(std::move(volume));
}

io::Mask threshold_of(const io::Volume& volume) {
  io::Mask mask;
  mask.geometry = volume.geometry;
  mask.size = volume.geometry.dimensions;
  for (int k = 0; k < mask.size.z; ++k) {
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const bool inside = volume.value_at(i, j, k) > 0.5 * (inside_hu + outside_hu);
        mask.occupancy.push_back(inside ? io::Mask::full : 0);
      }
    }
  }
  return mask;
}

struct EdgeErrors {
  double largest_mm = 0, sum = 0, squares = 0;
  int count = 0;

  void add(double mm) {
    largest_mm = std::max(largest_mm, std::abs(mm));
    sum += mm;
    squares += mm * mm;
    ++count;
  }
  double mean_mm() const { return sum / count; }
  double rms_mm() const { return std::sqrt(squares / count); }
};

struct EdgeRow {
  EdgeErrors labels, own;
  int none = 0;
};

EdgeRow edge_row_of(const Ball& ball) {
  const auto volume = scan_of_ball(ball);
  const auto structure = io::distance_of(threshold_of(*volume));
  const io::VolumeFields values(volume, io::FieldSet::value | io::FieldSet::gradient, 1,
                                {.gradient = io::GradientMethod::cubic, .brick_bytes = 0, .background = false});
  EdgeRow row;
  std::mt19937 random(1);
  std::normal_distribution<double> any;
  for (int n = 0; n < rays_of_ball; ++n) {
    const glm::dvec3 way = any_direction(random, any);
    const double in = radius_along(*structure, ball.center, way, ball.radius + 6);
    row.labels.add(in - ball.radius);
    constexpr double within_mm = 5;
    const auto edge = io::scan_edge({values, volume->geometry}, *structure, ball.center + in * way, way, within_mm);
    if (edge) {
      row.own.add(in + edge->mm - ball.radius);
    } else {
      ++row.none;
    }
  }
  return row;
}

}  // namespace

std::string tabulate_own_edges() {
  fmt::print(
      "\nBalls of {} HU in {} HU, blurred by {} mm; their labels: the values above the middle; {} rays. Errors in "
      "mm\n\n"
      "{:>10} {:>8} {:>8}   {:>8} {:>8} {:>8}   {:>8} {:>8} {:>8} {:>6}\n",
      inside_hu, outside_hu, scanner_mm, rays_of_ball, "radius mm", "h mm", "noise HU", "labels", "rms", "mean",
      "own edge", "rms", "mean", "none");
  std::string csv =
      "radius_mm,slices_mm,noise_hu,labels_largest_mm,labels_rms_mm,labels_mean_mm,own_largest_mm,own_rms_mm,own_mean_"
      "mm,"
      "none\n";
  constexpr std::array<std::array<double, 2>, 4> balls{{{20, 1}, {20, 3}, {20, 5}, {3, 1}}};
  for (const auto& [radius, step] : balls) {
    for (const double noise : {0.0, 15.0}) {
      const EdgeRow row = edge_row_of({radius, step, noise, {0.31, -0.17, 0.23 * step}});
      const EdgeErrors &labels = row.labels, &own = row.own;
      fmt::print("{:10.0f} {:8.0f} {:8.0f}   {:8.2f} {:8.3f} {:8.3f}   {:8.2f} {:8.3f} {:8.3f} {:6}\n", radius, step,
                 noise, labels.largest_mm, labels.rms_mm(), labels.mean_mm(), own.largest_mm, own.rms_mm(),
                 own.mean_mm(), row.none);
      csv += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", radius, step, noise, labels.largest_mm, labels.rms_mm(),
                         labels.mean_mm(), own.largest_mm, own.rms_mm(), own.mean_mm(), row.none);
    }
  }
  return csv;
}

}  // namespace palpate::plugin
