#include "modes/scene/suggest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "io/quantile.h"
#include "modes/scene/boundary_names.h"
#include "modes/scene/ct_tissues.h"
#include "modes/scene/defaults.h"
#include "modes/scene/hills.h"

namespace palpate::modes {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr int value_bins = 768;
constexpr double outer_share = 1e-3;  // of the values on each side that do not count for the range
constexpr double margin = 0.1;        // of the range, on each side of it
constexpr double least_step = 0.06;   // of the range: less is texture, not a boundary
constexpr double bandwidth_of_range = 0.008;
constexpr float valley_floor = 0.05F;  // of the lower of two hills
constexpr double prominence = 0.15, tissue_mass = 0.01;
constexpr double boundary_share = 0.02;  // of the voxels at boundaries
// Of a typical boundary's steepest gradient: where its strength begins, and where it is whole. What is thin or faint
// has a small part of the gradient, and is a boundary all the same.
// Where between two tissues the boundary is. Bone comes in all degrees from cancellous to cortical: its boundary is
// nearer to soft tissue, so that a sternum of 400 HU is bone beside a skull of 1000.
constexpr double usual_place = 0.5, bone_place = 0.3;
constexpr double least_soft_hu = -200, least_bone_hu = 150;
constexpr double ramp_from = 0.08, ramp_to = 0.2;
constexpr std::size_t most_boundaries = 8;  // as many as have a color
// Okabe and Ito's colors: told apart by the color-blind too. Source: "Color universal design", 2008.
constexpr std::array<const char*, most_boundaries> colors{"#e69f00", "#0072b2", "#009e73", "#d55e00",
                                                          "#56b4e9", "#cc79a7", "#f0e442", "#999999"};

struct Spread {
  double low = 0, high = 0;  ///< nearly all values lie between
  double noise = 0;          ///< standard deviation from a voxel to its neighbor, over sqrt(2)
};

Spread spread_of(const io::Volume& volume) {
  const glm::ivec3& size = volume.geometry.dimensions;
  constexpr std::uint64_t enough = 500'000;
  const std::uint64_t stride = 1 + volume.offset(0, 0, size.z) / enough;
  std::vector<double> values, differences;
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const std::uint64_t hash = (volume.offset(i, j, k) * 0x9E3779B97F4A7C15U) >> 32U;
        if (hash % stride != 0 || volume.is_padding(i, j, k) || !std::isfinite(volume.value_at(i, j, k))) {
          continue;
        }
        values.push_back(volume.value_at(i, j, k));
        if (i > 0 && !volume.is_padding(i - 1, j, k)) {
          const double difference = std::abs(values.back() - volume.value_at(i - 1, j, k));
          if (difference > 0) {  // a background that was cut off at one value says nothing about noise
            differences.push_back(difference);
          }
        }
      }
    }
  }
  // The median of |a - b| is 0.954 standard deviations of Gaussian noise; edges are too few to matter.
  return {io::quantile(values, outer_share), io::quantile(values, 1 - outer_share),
          io::quantile(std::move(differences), 0.5) / 0.954};
}

std::string whole_number(double value) {
  return std::to_string(std::lround(value));
}

std::vector<std::string> names_of(const std::vector<double>& typical, const io::Volume& volume) {
  std::vector<std::string> names;
  const std::size_t count = typical.size();
  for (std::size_t t = 0; t < count; ++t) {
    if (volume.unit == "HU") {
      names.push_back(ct_tissue(typical[t]));
    } else {
      names.push_back("tissue " + std::to_string(t + 1) + " of " + std::to_string(count) +
                      (t == 0 ? " (darkest)" : (t + 1 == count ? " (brightest)" : "")));
    }
  }
  const std::vector<std::string> plain = names;
  for (std::size_t t = 0; t < count; ++t) {
    if (std::count(plain.begin(), plain.end(), plain[t]) > 1) {
      names[t] += " (" + whole_number(typical[t]) + " HU)";
    }
  }
  return names;
}

/// Four significant digits: what a person can read and edit.
double readable(double value) {
  if (value == 0 || !std::isfinite(value)) {
    return value;
  }
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3);
  return std::round(value / unit) * unit;
}

struct Found {
  std::vector<internal::Hill> hills;
  std::vector<double> typical;
};

int bins_of_least_step(const io::Bins& values) {
  return static_cast<int>(least_step / (1 + 2 * margin) * values.count);
}

/// Of the way from one typical value to another.
double place_between(double low, double high, bool is_ct) {
  const bool is_soft = low > least_soft_hu && low < least_bone_hu;
  return is_ct && is_soft && high > least_bone_hu ? bone_place : usual_place;
}

/// Neighbors part within the valley between them, which may be wide and empty: in its middle, or nearer to what is
/// softer than bone.
void part_neighbors(std::span<const float> curve, const io::Bins& values, bool is_ct,
                    std::vector<internal::Hill>& hills) {
  for (std::size_t h = 1; h < hills.size(); ++h) {
    const float* left = curve.data() + hills[h - 1].top;
    const float* right = curve.data() + hills[h].top;
    const float floor = *std::min_element(left, right) + valley_floor * std::min(*left, *right);
    const auto is_floor = [=](float height) { return height <= floor; };
    const float* first = std::find_if(left, right, is_floor);
    const float* last = right;
    while (last > first && !is_floor(*last)) {
      --last;
    }
    const double place = place_between(values.middle(static_cast<int>(hills[h - 1].top)),
                                       values.middle(static_cast<int>(hills[h].top)), is_ct);
    hills[h].first = hills[h - 1].end =
        static_cast<std::size_t>((first - curve.data()) + std::lround(place * static_cast<double>(last - first)));
  }
}

Found find_tissues(const io::LowHighHistogram& edges, double bandwidth, bool is_ct) {
  const int bins = edges.values.count;
  const int least_bins = bins_of_least_step(edges.values);
  cv::Mat1f both(1, bins, 0.0F);
  // The outermost bins hold what lies beyond them: of no one value.
  for (int high = 1; high < bins - 1; ++high) {
    for (int low = 1; low < high - least_bins; ++low) {
      const auto count = static_cast<float>(edges.at(low, high));
      both(0, low) += count;
      both(0, high) += count;
    }
  }
  cv::Mat1f smooth;
  cv::GaussianBlur(both, smooth, cv::Size(0, 0), bandwidth / edges.values.width(), 0, cv::BORDER_REPLICATE);
  Found found;
  const std::span<const float> curve(smooth[0], static_cast<std::size_t>(bins));
  found.hills = internal::hills_of(curve, prominence, tissue_mass);
  part_neighbors(curve, edges.values, is_ct, found.hills);
  for (const internal::Hill& hill : found.hills) {
    // The middle of what lies near the top: the top alone is one bin of many.
    const int reach = static_cast<int>(2 * bandwidth / edges.values.width());
    double sum = 0, weighted = 0;
    for (int bin = std::max(static_cast<int>(hill.first), static_cast<int>(hill.top) - reach);
         bin < std::min(static_cast<int>(hill.end), static_cast<int>(hill.top) + reach + 1); ++bin) {
      const auto count = static_cast<double>(both(0, bin));
      sum += count;
      weighted += count * edges.values.middle(bin);
    }
    found.typical.push_back(sum > 0 ? weighted / sum : edges.values.middle(static_cast<int>(hill.top)));
  }
  return found;
}

std::vector<Tissue> tissues_of(const Found& found, const io::Bins& values, const io::Volume& volume) {
  const std::vector<std::string> names = names_of(found.typical, volume);
  std::vector<Tissue> tissues;
  for (std::size_t t = 0; t < found.hills.size(); ++t) {
    const bool last = t + 1 == found.hills.size();
    Tissue tissue;
    tissue.name = names[t];
    tissue.low = t == 0 ? -infinity : tissues.back().high;
    tissue.high = last ? infinity : readable(values.low + static_cast<double>(found.hills[t].end) * values.width());
    // A tenth of the way to the nearest tissue: neighbors share the soft end between them.
    double nearest = infinity;
    if (t > 0) nearest = std::min(nearest, found.typical[t] - found.typical[t - 1]);
    if (!last) nearest = std::min(nearest, found.typical[t + 1] - found.typical[t]);
    tissue.softness = readable(0.1 * (std::isfinite(nearest) ? nearest : values.high - values.low));
    tissues.push_back(std::move(tissue));
  }
  return tissues;
}

std::vector<FoundBoundary> boundaries_of(const Found& found, const io::LowHighHistogram& edges, bool is_ct) {
  const std::size_t tissues = found.hills.size();
  std::vector<std::size_t> tissue_of_bin;
  for (std::size_t t = 0; t < tissues; ++t) {
    tissue_of_bin.resize(found.hills[t].end, t);
  }
  std::vector<std::uint64_t> counts(tissues * tissues);
  std::uint64_t all = 0;
  for (int high = 0; high < edges.values.count; ++high) {
    for (int low = 0; low < high - bins_of_least_step(edges.values); ++low) {
      all += edges.at(low, high);
      counts[tissue_of_bin[static_cast<std::size_t>(low)] * tissues + tissue_of_bin[static_cast<std::size_t>(high)]] +=
          edges.at(low, high);
    }
  }
  std::vector<FoundBoundary> boundaries;
  for (std::size_t low = 0; low < tissues; ++low) {
    for (std::size_t high = low + 1; high < tissues; ++high) {
      const double share =
          static_cast<double>(counts[low * tissues + high]) / static_cast<double>(std::max<std::uint64_t>(all, 1));
      if (share >= boundary_share) {
        // Two kinds of bone part from each other where they do, and not where bone begins.
        const bool is_first = high == 0 || found.typical[high - 1] < least_bone_hu;
        const double place = place_between(found.typical[low], found.typical[high], is_ct && is_first);
        const double middle = found.typical[low] + place * (found.typical[high] - found.typical[low]);
        boundaries.push_back({.low = low, .high = high, .middle = middle, .share = share});
      }
    }
  }
  std::stable_sort(boundaries.begin(), boundaries.end(),
                   [](const FoundBoundary& a, const FoundBoundary& b) { return a.share > b.share; });
  boundaries.resize(std::min(boundaries.size(), most_boundaries));
  return boundaries;
}

/// Factors that set in at the boundary's middle, on the way up or on the way down.
TransferFunction beyond_the_middle(const FoundBoundary& boundary, double step, double factor, bool up) {
  const double way = up ? step : -step;
  std::vector<Node> nodes{{readable(boundary.middle - 0.08 * way), 0},
                          {readable(boundary.middle + 0.02 * way), factor}};
  if (!up) std::swap(nodes[0], nodes[1]);
  return TransferFunction(std::move(nodes));
}

Mode surface_for(const FoundBoundary& boundary, const Suggestion& suggestion, const std::string& name, double scale_mm,
                 bool is_ct, bool up) {
  const double step = suggestion.typical[boundary.high] - suggestion.typical[boundary.low];
  // Steepest gradient of a step at a scale.
  const double peak = step / (scale_mm * std::sqrt(2 * std::numbers::pi));
  const bool is_hard = is_ct && suggestion.typical[boundary.high] > least_bone_hu;
  Mode mode;
  mode.type = "surface";
  mode.from = suggestion.scene.tissues[up ? boundary.low : boundary.high].name;
  mode.to = suggestion.scene.tissues[up ? boundary.high : boundary.low].name;
  mode.enabled = up;
  mode.name = up ? name : way_back_name(name);
  mode.strength_of = Datum::gradient_magnitude;
  mode.strength_n =
      TransferFunction({{readable(ramp_from * peak), 0},
                        {readable(ramp_to * peak), is_hard ? defaults::bone_strength_n : defaults::skin_strength_n}});
  mode.gates = {{Datum::value, beyond_the_middle(boundary, step, 1, up)}};
  return mode;
}

Mode friction_above(const FoundBoundary& boundary, const Suggestion& suggestion) {
  const double step = suggestion.typical[boundary.high] - suggestion.typical[boundary.low];
  Mode mode;
  mode.type = "friction";
  mode.name = "friction";
  mode.strength_of = Datum::value;
  mode.strength_n = beyond_the_middle(boundary, step, defaults::friction_strength_n, true);
  return mode;
}

}  // namespace

Suggestion suggest(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress, int threads) {
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  const io::GradientKernel kernel(volume, scale_mm);
  const Spread spread = spread_of(*volume);
  const double range = spread.high - spread.low;
  Suggestion suggestion;
  suggestion.scene.name = "Suggested for this " + (volume->modality.empty() ? "scan" : volume->modality);
  if (!(range > 0)) {
    suggestion.scene.description = "The scan has one value only, and no boundary.";
    return suggestion;
  }
  const double steepest_of_least = least_step * range / (scale_mm * std::sqrt(2 * std::numbers::pi));
  suggestion.edges =
      io::low_high_histogram(*volume, kernel, {spread.low - margin * range, spread.high + margin * range, value_bins},
                             steepest_of_least, progress, threads);
  const bool is_ct = volume->unit == "HU";
  const Found found = find_tissues(suggestion.edges, std::max(bandwidth_of_range * range, 0.75 * spread.noise), is_ct);
  suggestion.typical = found.typical;
  suggestion.scene.tissues = tissues_of(found, suggestion.edges.values, *volume);
  suggestion.boundaries = boundaries_of(found, suggestion.edges, is_ct);
  std::vector<NamedPair> pairs;
  for (const FoundBoundary& boundary : suggestion.boundaries) {
    pairs.push_back({suggestion.typical[boundary.low], suggestion.typical[boundary.high]});
  }
  const std::vector<std::string> names = boundary_names(pairs, is_ct);
  const FoundBoundary* outermost = nullptr;
  for (std::size_t b = 0; b < suggestion.boundaries.size(); ++b) {
    FoundBoundary& boundary = suggestion.boundaries[b];
    boundary.mode = b;
    suggestion.scene.modes.push_back(surface_for(boundary, suggestion, names[b], scale_mm, is_ct, true));
    suggestion.scene.modes.back().color = colors[b];
    if (outermost == nullptr || boundary.middle < outermost->middle) {
      outermost = &boundary;
    }
  }
  for (std::size_t b = 0; b < suggestion.boundaries.size(); ++b) {
    FoundBoundary& boundary = suggestion.boundaries[b];
    boundary.way_back = suggestion.scene.modes.size();
    suggestion.scene.modes.push_back(surface_for(boundary, suggestion, names[b], scale_mm, is_ct, false));
    suggestion.scene.modes.back().color = colors[b];
  }
  if (outermost != nullptr) {
    suggestion.scene.modes.push_back(friction_above(*outermost, suggestion));
  }
  suggestion.scene.description =
      "Tissues and boundaries as they were found in the scan: rename, switch and reshape them.";
  return suggestion;
}

}  // namespace palpate::modes
