#include "io/fields/boundary_uncertainty.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "io/quantile.h"

namespace palpate::io {
namespace {

constexpr std::size_t directions = 8;                         // of pairs, over half a turn
constexpr std::array<double, 4> reaches{2.5, 4.0, 5.5, 7.0};  // voxels: farther apart than one interpolation reaches
constexpr double slope_step = 0.25;                           // voxels, to both sides
constexpr double outlier = 3.0;                               // standard deviations: another structure
// Of the boundary's place by its phase between the voxels, rms, in voxels along an axis: as measured on tilted planes
// without noise. The cubic value is sharper along coarse axes (cubic_spline.h), and its phase shows more there.
constexpr double cubic_phase = 0.02, cubic_coarse_phase = 0.05, trilinear_phase = 0.04;
constexpr double most_stated_mm = 8;  // no edge is looked for farther away
constexpr double phase_seen = 0.7;    // of its variance: what differences on the tangent plane hold of it
constexpr double coarse = 1.5;        // times the finest spacing
// Variance of the blur, in voxels squared: of the voxel's box and of the interpolation.
// Of an edge's rise, in standard deviations of the value: less may be noise alone. Source: Rose, "The sensitivity
// performance of the human eye on an absolute scale", J. Opt. Soc. Am. 38 (1948): 3 to 5.
constexpr double least_rise_in_noise = 4.5;
// A disk of the tangent plane: eight places at its radius and eight half as far, and the middle. The mean square of
// their distances, voxels squared.
constexpr double disk_radius = 1.6;  // voxels
constexpr double disk_mean_square = disk_radius * disk_radius * 8 * (1 + 0.25) / 17;
constexpr double box_blur = 1.0 / 12, cubic_blur = box_blur + 0.58 * 0.58, trilinear_blur = box_blur + 1.0 / 6;

/// Two unit vectors perpendicular to a unit vector and to each other.
std::array<Vec3, 2> tangents_of(const Vec3& normal) {
  const Vec3 other = std::abs(normal.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 first = glm::normalize(glm::cross(normal, other));
  return {first, glm::cross(normal, first)};
}

/// 95 of 100 normal deviates around a bias are within this of zero; never too narrow, and at most 5 % too wide.
double within_95(double bias, double sigma) {
  constexpr double both_sides = 1.96, one_side = 1.645;
  const double apart = sigma > 0 ? bias / sigma : 0;
  return std::abs(bias) + sigma * (one_side + (both_sides - one_side) * std::exp(-3 * apart * apart));
}

/// Variance of a filter's blur along a unit direction, mm^2.
double filter_blur(const Geometry& geometry, const Filter& filter, const Vec3& direction) {
  return filter.type != nullptr && filter.type->blur != nullptr ? filter.type->blur(geometry, filter, direction) : 0;
}

/// Extent of a voxel along a unit direction, mm: how far one goes to the next voxel.
double voxel_along(const Geometry& g, const Vec3& direction) {
  const Vec3 normal = glm::cross(g.direction_i, g.direction_j);
  return glm::length(Vec3(glm::dot(g.direction_i, direction) * g.spacing_i,
                          glm::dot(g.direction_j, direction) * g.spacing_j,
                          glm::dot(normal, direction) * g.slice_spacing()));
}

/// rms of the boundary's place along a unit normal by its phase between the voxels, mm.
double phase_mm(const Geometry& g, ValueMethod value, const Vec3& normal) {
  const std::array axes{g.direction_i, g.direction_j, glm::cross(g.direction_i, g.direction_j)};
  const std::array spacings{g.spacing_i, g.spacing_j, g.slice_spacing()};
  const double finest = *std::min_element(spacings.begin(), spacings.end());
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double phase = value == ValueMethod::trilinear    ? trilinear_phase
                         : spacings[axis] > coarse * finest ? cubic_coarse_phase
                                                            : cubic_phase;
    const double along = phase * spacings[axis] * glm::dot(axes[axis], normal);
    sum += along * along;
  }
  return std::sqrt(sum);
}

struct Pair {
  double angle = 0;       // of the pair's direction in the tangent plane
  double apart_mm = 0;    // between its points
  double difference = 0;  // of their values
};

/// Second differences along the directions of a tangent plane.
struct Bend {
  std::vector<double> second;  // unit per mm^2, of each direction
  double noise = 0;            // of their mean, over the value's
};

struct PairSum {
  double apart_mm = 0;
  double sum = 0;  // of the values
};

/// Against the mean over a disk, which has less noise than the place itself; the disk's own bend is taken out of it.
Bend bend_of(const std::vector<PairSum>& pairs, double disk_mean, double disk_noise) {
  Bend bend;
  if (pairs.empty()) return bend;
  const auto count = static_cast<double>(pairs.size());
  double sum = 0, per_mm2 = 0;
  for (const PairSum& pair : pairs) {
    sum += pair.sum / count;
    per_mm2 += 4 / (pair.apart_mm * pair.apart_mm) / count;
  }
  constexpr double part = disk_mean_square / (reaches.front() * reaches.front());
  const double middle = (disk_mean - 0.5 * part * sum) / (1 - part);
  for (const PairSum& pair : pairs)
    bend.second.push_back(4 * (pair.sum - 2 * middle) / (pair.apart_mm * pair.apart_mm));
  bend.noise = per_mm2 * std::sqrt(4 * disk_noise * disk_noise / ((1 - part) * (1 - part)) + 2 / count);
  return bend;
}

/// Standard deviation of the value: of the pairs' differences less a tilt of the plane, without outliers.
double noise_of(const std::vector<Pair>& pairs) {
  // Least squares of difference = apart (a cos + b sin).
  double cc = 0, cs = 0, ss = 0, cd = 0, sd = 0;
  for (const Pair& p : pairs) {
    const double c = p.apart_mm * std::cos(p.angle), s = p.apart_mm * std::sin(p.angle);
    cc += c * c;
    cs += c * s;
    ss += s * s;
    cd += c * p.difference;
    sd += s * p.difference;
  }
  const double determinant = cc * ss - cs * cs;
  const double a = (ss * cd - cs * sd) / determinant, b = (cc * sd - cs * cd) / determinant;
  std::vector<double> residuals;
  residuals.reserve(pairs.size());
  for (const Pair& p : pairs) {
    residuals.push_back(std::abs(p.difference - p.apart_mm * (a * std::cos(p.angle) + b * std::sin(p.angle))));
  }
  const double robust = quantile(residuals, 0.5) / 0.6745;
  double sum = 0, count = 0;
  for (const double residual : residuals) {
    if (residual > outlier * robust) continue;
    sum += residual * residual;
    count += 1;
  }
  return count > 2 ? std::sqrt(sum / (count - 2) / 2) : 0;
}

/// The mean value over a small disk of the tangent plane, on the way along the normal: less noise than at one point.
class NormalProfile {
 public:
  NormalProfile(const FieldSource& source, const Geometry& geometry, const Vec3& place, const Vec3& normal)
      : source_(source), place_(place), normal_(normal), step_mm_(profile_step * voxel_along(geometry, normal)) {
    const auto tangents = tangents_of(normal);
    for (std::size_t n = 0; n < around_.size(); ++n) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(around_.size());
      const Vec3 along = std::cos(angle) * tangents[0] + std::sin(angle) * tangents[1];
      around_[n] = disk_radius * (n % 2 == 0 ? 1.0 : 0.5) * voxel_along(geometry, along) * along;
    }
  }

  /// NaN if less than half of the disk lies in the scan.
  double at(int step) const {
    const Vec3 middle = place_ + step * step_mm_ * normal_;
    double sum = 0, count = 0;
    const auto add = [&](const Vec3& place) {
      const Sample sample = source_.sample(place, FieldSet::value);
      if (!sample.inside) return;
      sum += sample.value;
      count += 1;
    };
    add(middle);
    for (const Vec3& away : around_) add(middle + away);
    return 2 * count > static_cast<double>(around_.size()) ? sum / count : std::numeric_limits<double>::quiet_NaN();
  }
  double step_mm() const noexcept { return step_mm_; }

 private:
  static constexpr double profile_step = 0.25;  // voxels
  const FieldSource& source_;
  Vec3 place_, normal_;
  double step_mm_;
  std::array<Vec3, 16> around_;
};

/// The step nearest to the place at which the value rises as steeply as the gradient says: 0 if it does so at the place
/// itself; empty if it does so nowhere near.
std::optional<int> edge_near(const NormalProfile& profile, double slope, double gradient) {
  constexpr double alike = 0.7;
  if (slope >= alike * gradient) return 0;
  const double rise = alike * gradient * profile.step_mm();
  for (int n = 1; n * profile.step_mm() <= most_stated_mm; ++n) {
    if (profile.at(n) - profile.at(n - 1) >= rise) return n;
    if (profile.at(1 - n) - profile.at(-n) >= rise) return -n;
  }
  return std::nullopt;
}

/// The edge that a boundary belongs to.
struct Edge {
  double beyond_mm = 0;  ///< from where the value is in the middle of its two sides to the place, along the normal
  double rise = 0;       ///< from the one side to the other
  double width_mm = 0;   ///< one standard deviation of the blur
  double unsure_mm = 0;  ///< one standard deviation of the middle, where a side is thinner than the blur
};

/// Which part of a side's value a blur lets it reach: 1 unless the value turns back before long. `end`: where it stops
/// rising, `way`: to which side, `half`: the edge; `width`: one standard deviation of the blur. All in steps. `seen`:
/// how thick a plate looks, over how thick it is taken to look.
double part_reached(const NormalProfile& profile, int end, int way, double middle, double half, double width,
                    double seen) {
  constexpr double thick = 6;      // standard deviations: more reaches all of its value
  constexpr double point = 2.355;  // a blurred plate without thickness is as wide, between half of its value
  for (int step = end; way * (step - half) < thick * width; step += way) {
    const double there = profile.at(step);
    if (!(way * (there - middle) <= 0)) continue;
    // A thin plate's blur looks narrower, and the plate thicker than it is. The root is within 4 % of the thickness.
    const double before = profile.at(step - way);
    const double plate = way * (step - way * (middle - there) / (before - there) - half) / seen;
    double sigma = width, part = 1;
    for (int n = 0; n < 50; ++n) {
      const double t = std::cbrt(std::max(0.1, std::pow(plate / sigma, 3) - std::pow(point, 3)));
      part = std::erf(t / (2 * std::numbers::sqrt2));
      sigma = width * (1 - std::exp(-0.5 * t * t)) / part;
    }
    return std::max(part, 0.4);
  }
  return 1;
}

/// Empty if there is no clear edge. `rise_noise`: standard deviation of the rise from one step to the next.
std::optional<Edge> edge_at(const NormalProfile& profile, double slope, double gradient, double value,
                            double rise_noise) {
  constexpr double flat = 0.1;    // of the steepest rise: there the side is reached
  constexpr double valley = 0.5;  // of the steepest rise: behind one that is lower begins another edge
  constexpr int most_steps = 40;
  const auto nearest = edge_near(profile, slope, gradient);
  if (!nearest) return std::nullopt;
  struct Point {
    int step;
    double value;
  };
  std::vector<Point> points{{*nearest, profile.at(*nearest)}};
  double steepest = std::max(slope, gradient) * profile.step_mm() * 0.5, steepest_seen = 0;
  for (const int way : {-1, 1}) {
    double highest = slope * profile.step_mm();  // rise so far on this way
    double lowest = highest;                     // rise since then
    std::size_t kept = points.size();            // up to the lowest
    for (int n = 1;; ++n) {
      if (n > most_steps) return std::nullopt;  // it rises for so long that it has no sides
      const Point& last = way < 0 ? points.front() : points.back();
      const Point next{last.step + way, profile.at(last.step + way)};
      const double rise = way * (next.value - last.value);
      if (!std::isfinite(rise)) return std::nullopt;  // the scan ends before the side does
      if (!(rise > std::max(flat * steepest, 2 * rise_noise))) break;
      if (lowest < valley * highest && rise > lowest + std::max(flat * highest, 3 * rise_noise)) {
        if (way < 0) {
          points.erase(points.begin(), points.end() - static_cast<std::ptrdiff_t>(kept));
        } else {
          points.resize(kept);
        }
        break;
      }
      if (rise > highest) {
        highest = lowest = rise;
      } else if (rise < lowest) {
        lowest = rise;
        kept = points.size() + 1;
      }
      steepest = std::max(steepest, rise);
      steepest_seen = std::max(steepest_seen, rise);
      points.insert(way < 0 ? points.begin() : points.end(), next);
    }
  }
  const double low = points.front().value, high = points.back().value;
  const auto crossing = [&](double level) -> std::optional<double> {
    const auto above = std::ranges::find_if(points, [&](const Point& point) { return point.value >= level; });
    if (above == points.begin() || above == points.end()) return std::nullopt;
    const Point& below = *(above - 1);
    return below.step + (level - below.value) / (above->value - below.value);
  };
  const auto half = crossing(0.5 * (low + high));
  if (!half) return std::nullopt;
  const double width = (high - low) / (steepest_seen * std::sqrt(2 * std::numbers::pi));  // steps, of the blur
  // Sides that are thinner than the blur do not reach their values: the middle is more than half of the observed rise.
  const auto middle_at = [&](double seen) -> std::optional<double> {
    const double mean = 0.5 * (low + high);
    const double raised = part_reached(profile, points.back().step, 1, mean, *half, width, seen);
    const double lowered = part_reached(profile, points.front().step, -1, mean, *half, width, seen);
    return crossing(mean + 0.5 * (high - low) * (1 / raised - 1 / lowered));
  };
  constexpr double seen_wider = 1.12;  // beside a neighbor that is more like the thin side than the first is
  const auto at = middle_at(1), at_thinner = middle_at(seen_wider);
  if (!at || !at_thinner) return std::nullopt;
  // The disk's mean differs from the value at the place; the same difference applies at the middle.
  const double place = *nearest == 0 && slope > 0 ? (value - profile.at(0)) / slope : 0;
  return Edge{.beyond_mm = place - *at * profile.step_mm(),
              .rise = points.back().value - points.front().value,
              .width_mm = width * profile.step_mm(),
              .unsure_mm = std::max(0.4 * std::abs(*at - *half), std::abs(*at - *at_thinner)) * profile.step_mm()};
}

}  // namespace

BoundaryUncertainty uncertainty_at(const FieldSource& source, const Geometry& geometry, ValueMethod value,
                                   const Vec3& place_mm, const Filter& filter) {
  BoundaryUncertainty result;
  result.two_sigma_mm = std::numeric_limits<double>::infinity();
  const Sample here = source.sample(place_mm, FieldSet::value | FieldSet::gradient);
  if (!here.inside || !(glm::length(here.gradient) > 0)) return result;
  const Vec3 normal = glm::normalize(here.gradient);
  const double voxel = voxel_along(geometry, normal);
  const auto tangents = tangents_of(normal);

  double slopes = 0, slope_count = 0;
  const auto add_slope = [&](const Vec3& place) {
    const Sample behind = source.sample(place - slope_step * voxel * normal, FieldSet::value);
    const Sample before = source.sample(place + slope_step * voxel * normal, FieldSet::value);
    if (!behind.inside || !before.inside) return;
    slopes += (before.value - behind.value) / (2 * slope_step * voxel);
    slope_count += 1;
  };
  add_slope(place_mm);
  const NormalProfile profile(source, geometry, place_mm, normal);
  std::vector<Pair> pairs;
  std::vector<PairSum> nearest;
  std::vector<Vec3> nearest_ways;
  const double blur = value == ValueMethod::cubic ? cubic_blur : trilinear_blur;
  for (std::size_t n = 0; n < directions; ++n) {
    const double angle = std::numbers::pi * static_cast<double>(n) / directions;
    const Vec3 along = std::cos(angle) * tangents[0] + std::sin(angle) * tangents[1];
    const double step = voxel_along(geometry, along);
    for (const double reach : reaches) {
      const Vec3 away = reach * step * along;
      const Sample one = source.sample(place_mm + away, FieldSet::value);
      const Sample other = source.sample(place_mm - away, FieldSet::value);
      if (!one.inside || !other.inside) continue;
      pairs.push_back({.angle = angle, .apart_mm = 2 * reach * step, .difference = one.value - other.value});
      if (reach > reaches.front()) continue;
      nearest.push_back({.apart_mm = 2 * reach * step, .sum = one.value + other.value});
      nearest_ways.push_back(along);
    }
    // The slope of neighbors on the tangent plane, half a voxel aside: more of them, less noise.
    add_slope(place_mm + 0.5 * step * along);
    add_slope(place_mm - 0.5 * step * along);
  }
  if (slope_count == 0 || pairs.size() < 2 * directions) return result;
  result.slope = slopes / slope_count;
  result.noise = noise_of(pairs);
  if (!(result.slope > 0)) return result;
  result.noise_mm = result.noise / result.slope;
  result.sampling_mm = phase_mm(geometry, value, normal);
  // Noise of the mean over a disk, relative to that of the value: interpolation and filter correlate the noise of
  // neighbors.
  const double joined = blur - box_blur + filter_blur(geometry, filter, tangents[0]) / (voxel * voxel);
  const double disk_noise = 1 / std::sqrt(1 + 0.5 * disk_radius * disk_radius / joined);
  const double step = profile.step_mm() / voxel;
  const double rise_noise = std::sqrt(2 * (1 - std::exp(-step * step / (4 * joined)))) * disk_noise * result.noise;
  const auto edge = edge_at(profile, result.slope, glm::length(here.gradient), here.value, rise_noise);
  if (!edge || edge->rise < least_rise_in_noise * result.noise) return result;
  result.level_mm = edge->beyond_mm;
  // A scanner's blur is seen in the edge's own width, and is taken to be alike in all directions.
  const double of_scanner =
      std::max(0.0, edge->width_mm * edge->width_mm - blur * voxel * voxel - filter_blur(geometry, filter, normal));
  const Bend bend = bend_of(nearest, profile.at(0), disk_noise);
  double shift = 0, of_bend = 0;
  for (std::size_t n = 0; n < nearest_ways.size(); ++n) {
    const double step = voxel_along(geometry, nearest_ways[n]);
    const double variance = blur * step * step + filter_blur(geometry, filter, nearest_ways[n]) + of_scanner;
    const double part = variance / static_cast<double>(nearest_ways.size());
    shift -= part * bend.second[n] / result.slope;
    of_bend += part * bend.noise * result.noise_mm;
  }
  result.curvature_mm = std::isfinite(shift) ? shift : 0;
  // The shift is measured, too: it has the noise of the second differences and of the middle. Noise also moves the two
  // ends of the edge, by the step at which it looks flat.
  const double of_end = rise_noise * edge->width_mm / profile.step_mm() / result.slope;
  const double of_level = std::hypot(disk_noise * result.noise_mm, of_end) / std::numbers::sqrt2;
  const double phase = result.sampling_mm * result.sampling_mm, noise = result.noise_mm * result.noise_mm;
  const double of_place = std::max(phase, noise + (1 - phase_seen) * phase);
  result.two_sigma_mm =
      within_95(result.curvature_mm + result.level_mm,
                std::sqrt(of_place + of_bend * of_bend + of_level * of_level + edge->unsure_mm * edge->unsure_mm));
  if (!(result.two_sigma_mm <= most_stated_mm)) result.two_sigma_mm = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace palpate::io
