#include "io/structures/scan_edge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <vector>

#include "io/fields/boundary_uncertainty.h"
#include "io/fields/cubic_spline.h"
#include "io/fields/volume_fields.h"

namespace palpate::io {
namespace {

constexpr double samples_a_voxel = 12;
constexpr double beyond_voxels = 4;     // that an edge at the end of the search may go on
constexpr double flat = 0.1;            // of the steepest slope: there the edge ends
constexpr double valley = 0.5;          // of the steepest slope: behind one that is lower begins another edge
constexpr double shoulder = 0.6;        // of the steepest slope: one that does not fall lower is none of its own
constexpr double least_of_noise = 6;    // standard deviations
constexpr double least_of_rises = 0.1;  // of the largest one nearby: less may be a ripple of the interpolation
constexpr double unsure_of_shift = 0.3;
constexpr double least_cosine = 0.2;  // 78 degrees between the way and the surface's normal

/// Values and slopes along the way in equal steps, mm.
struct Line {
  double first = 0, step = 1;
  std::vector<double> value, slope;

  std::size_t size() const { return value.size(); }
  double at(double n) const { return first + n * step; }
};

double interpolated(const std::vector<double>& numbers, double n) {
  const auto below = std::min(static_cast<std::size_t>(n), numbers.size() - 2);
  const double part = n - static_cast<double>(below);
  return (1 - part) * numbers[below] + part * numbers[below + 1];
}

/// As much of it as lies in the scan without a break.
Line line_through(const ScanValues& scan, const Vec3& place, const Vec3& way, double within_mm) {
  const double voxels_per_mm = glm::distance(scan.geometry.to_index(place + way), scan.geometry.to_index(place));
  Line line;
  line.step = 1 / (samples_a_voxel * voxels_per_mm);
  const int half = static_cast<int>(std::ceil((within_mm + beyond_voxels / voxels_per_mm) / line.step));
  for (int n = -half; n <= half; ++n) {
    const double mm = n * line.step;
    const Sample sample = scan.source.sample(place + mm * way, FieldSet::value | FieldSet::gradient);
    if (!sample.inside) {
      if (mm > 0) break;
      line.value.clear();
      line.slope.clear();
      continue;
    }
    if (line.value.empty()) line.first = mm;
    line.value.push_back(sample.value);
    line.slope.push_back(glm::dot(sample.gradient, way));
  }
  return line;
}

/// The end of the edge around its steepest place, towards the line's first or last place: where it is flat, or in the
/// valley before another edge, which may already be `taken`.
std::size_t end_of(const Line& line, const std::vector<bool>& taken, std::size_t steepest, std::size_t outermost) {
  const double sign = line.slope[steepest] > 0 ? 1 : -1;
  const double most = sign * line.slope[steepest];
  std::size_t lowest = steepest;
  for (std::size_t n = steepest; n != outermost;) {
    n = n < outermost ? n + 1 : n - 1;
    if (taken[n]) return lowest;
    const double slope = sign * line.slope[n], least = sign * line.slope[lowest];
    if (slope < least) lowest = n;
    if (slope <= flat * most) return n;
    if (least < valley * most && slope > least + flat * most) return lowest;
  }
  return lowest;
}

struct Edge {
  double mm = 0, rise = 0, slope = 0;
  double sigma_mm = 0;  ///< of the Gaussian that has blurred a step to this
};

/// The place, in steps, where the slope has fallen to `level` on the way from `inner` to `outer`.
double cut(const Line& line, std::size_t outer, std::size_t inner, double level) {
  const double sign = line.slope[inner] > 0 ? 1 : -1;
  std::size_t n = outer;
  while (n != inner && sign * line.slope[n] < level) n = n < inner ? n + 1 : n - 1;
  if (n == outer) return static_cast<double>(outer);
  const std::size_t before = outer < inner ? n - 1 : n + 1;
  const double here = sign * line.slope[n], there = sign * line.slope[before];
  const double part = (here - level) / (here - there);
  return static_cast<double>(n) + part * (static_cast<double>(before) - static_cast<double>(n));
}

Edge edge_between(const Line& line, std::size_t begin, std::size_t steepest, std::size_t end) {
  Edge edge;
  edge.slope = line.slope[steepest];
  const double most = std::abs(edge.slope), sign = edge.slope > 0 ? 1 : -1;
  const double level = std::max({flat * most, sign * line.slope[begin], sign * line.slope[end]});
  const double from = cut(line, begin, steepest, level), to = cut(line, end, steepest, level);
  const double low = interpolated(line.value, from), high = interpolated(line.value, to);
  const double middle = 0.5 * (low + high);
  auto n = static_cast<std::size_t>(from);
  while (static_cast<double>(n + 1) < to && (line.value[n + 1] - middle) * sign < 0) ++n;
  const double part = (middle - line.value[n]) / (line.value[n + 1] - line.value[n]);
  edge.mm = line.at(static_cast<double>(n) + part);
  // The part of a Gaussian step between two places with this slope, and its width.
  const double reach = std::sqrt(-2 * std::log(std::min(level / most, 0.9)));
  edge.rise = (high - low) / std::erf(reach / std::numbers::sqrt2);
  edge.sigma_mm = std::abs(edge.rise) / (most * std::sqrt(2 * std::numbers::pi));
  return edge;
}

/// All of a line that lie within reach, the nearest first.
std::vector<Edge> edges_of(const Line& line, double within_mm) {
  std::vector<std::size_t> steepest;
  for (std::size_t n = 1; n + 1 < line.size(); ++n) {
    const double here = std::abs(line.slope[n]);
    if (here > std::abs(line.slope[n - 1]) && here >= std::abs(line.slope[n + 1])) steepest.push_back(n);
  }
  std::sort(steepest.begin(), steepest.end(),
            [&](std::size_t a, std::size_t b) { return std::abs(line.slope[a]) > std::abs(line.slope[b]); });
  std::vector<bool> taken(line.size());
  std::vector<Edge> edges;
  for (const std::size_t n : steepest) {
    if (taken[n]) continue;
    const std::size_t begin = end_of(line, taken, n, 0), end = end_of(line, taken, n, line.size() - 1);
    for (std::size_t of_it = begin; of_it <= end; ++of_it) taken[of_it] = true;
    // A shoulder of an edge, or cut off by the end of the scan.
    const double most = std::abs(line.slope[n]);
    if (std::max(std::abs(line.slope[begin]), std::abs(line.slope[end])) > shoulder * most) continue;
    const Edge edge = edge_between(line, begin, n, end);
    if (std::abs(edge.mm) <= within_mm) edges.push_back(edge);
  }
  double most = 0;
  for (const Edge& edge : edges) most = std::max(most, std::abs(edge.rise));
  std::erase_if(edges, [&](const Edge& edge) { return std::abs(edge.rise) < least_of_rises * most; });
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return std::abs(a.mm) < std::abs(b.mm); });
  return edges;
}

/// The variance of what voxel and interpolation blur, mm^2.
glm::dmat3 blur_of(const Geometry& g) {
  const std::array axes{g.direction_i, g.direction_j, glm::cross(g.direction_i, g.direction_j)};
  const std::array spacings{g.spacing_i, g.spacing_j, g.slice_spacing()};
  const Vec3 part = b_spline_part(g);
  glm::dmat3 blur(0);
  for (int n = 0; n < 3; ++n) {
    const auto axis = static_cast<std::size_t>(n);
    blur += spacings[axis] * spacings[axis] * (1.0 / 12 + part[n] / 3) * glm::outerProduct(axes[axis], axes[axis]);
  }
  return blur;
}

/// How far, along the structure's inward normal, blur has shifted the edge.
double shift_mm(const Geometry& g, const DistanceField& structure, const Vec3& place, const Vec3& inward,
                double sigma_mm) {
  const double apart = std::cbrt(g.spacing_i * g.spacing_j * g.slice_spacing());
  glm::dmat3 bend;  // the second derivatives of the distance
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 aside(0);
    aside[axis] = apart;
    bend[axis] = (structure.sample(place + aside).gradient - structure.sample(place - aside).gradient) / (2 * apart);
  }
  glm::dmat3 blur = blur_of(g);
  const double scanner = std::max(0.0, sigma_mm * sigma_mm - glm::dot(inward, blur * inward));
  blur += scanner * glm::dmat3(1);
  const glm::dmat3 tangent = glm::dmat3(1) - glm::outerProduct(inward, inward);
  const glm::dmat3 along = tangent * blur * tangent;
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) sum += glm::dot(along[axis], bend[axis]);
  return std::clamp(-0.5 * sum, -0.5 * sigma_mm, 0.5 * sigma_mm);
}

}  // namespace

std::shared_ptr<const FieldSource> edge_fields(const std::shared_ptr<const Volume>& scan) {
  constexpr double any_scale_mm = 1;  // read by other gradients
  return std::make_shared<const VolumeFields>(scan, FieldSet::value | FieldSet::gradient, any_scale_mm,
                                              FieldOptions{.gradient = GradientMethod::cubic, .brick_bytes = 0});
}

std::optional<ScanEdge> scan_edge(const ScanValues& scan, const DistanceField& structure, const Vec3& place_mm,
                                  const Vec3& way, double within_mm) {
  const Vec3 gradient = structure.sample(place_mm).gradient;
  const double steepness = glm::length(gradient);
  if (!(steepness > 0)) return std::nullopt;
  const Vec3 inward = gradient / steepness;
  const double cosine = glm::dot(inward, way);
  if (std::abs(cosine) < least_cosine) return std::nullopt;
  const Line line = line_through(scan, place_mm, way, within_mm);
  for (const Edge& edge : edges_of(line, within_mm)) {
    const BoundaryUncertainty there =
        uncertainty_at(scan.source, scan.geometry, ValueMethod::cubic, place_mm + edge.mm * way);
    if (!std::isfinite(there.two_sigma_mm) || std::abs(edge.rise) < least_of_noise * there.noise) continue;
    const double shift = shift_mm(scan.geometry, structure, place_mm, inward, edge.sigma_mm * std::abs(cosine));
    const double one_sigma = std::max(there.noise / std::abs(edge.slope), there.sampling_mm / std::abs(cosine));
    return ScanEdge{.mm = edge.mm - shift / cosine,
                    .rise = edge.rise,
                    .known_to_mm = 2 * one_sigma + unsure_of_shift * std::abs(shift / cosine)};
  }
  return std::nullopt;
}

}  // namespace palpate::io
