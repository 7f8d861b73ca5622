#include "modes/scene/suggest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "modes/scene/boundary_names.h"
#include "modes/scene/ct_tissues.h"
#include "modes/scene/defaults.h"
#include "modes/scene/edge_sites.h"
#include "modes/scene/faint_walls.h"
#include "modes/scene/head_shape.h"
#include "modes/scene/merge_boundaries.h"
#include "modes/scene/number_text.h"

#include "modes/scene/regions.h"
#include "modes/scene/scan_noise.h"
#include "modes/scene/tissue_colors.h"
#include "modes/scene/tissue_hills.h"

namespace palpate::modes {
namespace {

using internal::least_bone_hu;
using internal::place_between;
using internal::TissueHills;

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr int value_bins = 768;
constexpr double margin = 0.1;       // of the range, on each side of it
constexpr double least_step = 0.06;  // of the range: less is texture, not a boundary
constexpr double bandwidth_of_range = 0.008;
constexpr double boundary_share = 0.02;  // of the voxels at boundaries
// Of a typical boundary's steepest gradient: where its strength begins, and where it is whole. What is thin or faint
// has a small part of the gradient, and is a boundary all the same.
constexpr double ramp_from = 0.08, ramp_to = 0.2;
constexpr double least_in_noise = 4;        // standard deviations of the gradient, where a faint wall is felt
constexpr std::size_t most_boundaries = 8;  // as many as have a color
static_assert(most_boundaries == tissue_colors.size());

std::vector<std::string> names_of(const std::vector<double>& typical, const io::Volume& volume, double range) {
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
      names[t] += " (" + number_text(typical[t], range) + " HU)";
    }
  }
  return names;
}

/// Four significant digits of the value, or of the range where that is less: what a person can read and edit.
double readable(double value, double range) {
  if (value == 0 || !std::isfinite(value)) {
    return value;
  }
  return rounded_to(value, static_cast<int>(std::floor(std::log10(std::min(std::abs(value), range)))) - 3);
}

int bins_of_least_step(const io::Bins& values) {
  return static_cast<int>(least_step / (1 + 2 * margin) * values.count);
}

std::vector<Tissue> tissues_of(const TissueHills& found, const io::Bins& values, const io::Volume& volume) {
  const double range = values.high - values.low;
  const std::vector<std::string> names = names_of(found.typical, volume, range);
  std::vector<Tissue> tissues;
  for (std::size_t t = 0; t < found.hills.size(); ++t) {
    const bool last = t + 1 == found.hills.size();
    Tissue tissue;
    tissue.name = names[t];
    tissue.low = t == 0 ? -infinity : tissues.back().high;
    tissue.high =
        last ? infinity : readable(values.low + static_cast<double>(found.hills[t].end) * values.width(), range);
    // A tenth of the way to the nearest tissue: neighbors share the soft end between them.
    double nearest = infinity;
    if (t > 0) nearest = std::min(nearest, found.typical[t] - found.typical[t - 1]);
    if (!last) nearest = std::min(nearest, found.typical[t + 1] - found.typical[t]);
    tissue.softness = readable(0.1 * (std::isfinite(nearest) ? nearest : range), range);
    tissues.push_back(std::move(tissue));
  }
  return tissues;
}

/// Edges of at least the least step, by the two tissues that they lie between.
struct PairCounts {
  std::size_t tissues = 0;
  std::vector<std::uint64_t> counts;
  double all = 0;

  double share(std::size_t low, std::size_t high) const {
    return static_cast<double>(counts[low * tissues + high]) / std::max(all, 1.0);
  }
};

PairCounts count_pairs(const TissueHills& found, const io::LowHighHistogram& edges) {
  const std::size_t tissues = found.hills.size();
  std::vector<std::size_t> tissue_of_bin;
  for (std::size_t t = 0; t < tissues; ++t) {
    tissue_of_bin.resize(found.hills[t].end, t);
  }
  PairCounts pairs{tissues, std::vector<std::uint64_t>(tissues * tissues)};
  for (int high = 0; high < edges.values.count; ++high) {
    for (int low = 0; low < high - bins_of_least_step(edges.values); ++low) {
      pairs.all += static_cast<double>(edges.at(low, high));
      pairs.counts[tissue_of_bin[static_cast<std::size_t>(low)] * tissues +
                   tissue_of_bin[static_cast<std::size_t>(high)]] += edges.at(low, high);
    }
  }
  return pairs;
}

std::vector<FoundBoundary> boundaries_of(const TissueHills& found, const PairCounts& pairs, bool is_ct) {
  const std::size_t tissues = found.hills.size();
  std::vector<FoundBoundary> boundaries;
  for (std::size_t low = 0; low < tissues; ++low) {
    for (std::size_t high = low + 1; high < tissues; ++high) {
      const double share = pairs.share(low, high);
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
  return boundaries;
}

/// Each side of a faint wall is a tissue of its own, beside the one that both are part of: so the boundaries of that
/// one stay as they are.
void add_faint_walls(std::vector<internal::FaintWall> walls, double range, Suggestion& suggestion,
                     std::vector<double>& noise_gradients) {
  walls.resize(std::min(walls.size(), most_boundaries - suggestion.boundaries.size()));
  std::vector<Tissue>& tissues = suggestion.scene.tissues;
  for (const internal::FaintWall& wall : walls) {
    const std::string tissue = tissues[wall.within].name;
    std::size_t low = 0, high = 0;
    for (const auto& [side, typical, which] :
         {std::tuple(wall.low_side, wall.low, "darker"), std::tuple(wall.high_side, wall.high, "brighter")}) {
      std::size_t& index = which == std::string_view("darker") ? low : high;
      const std::string name = tissue + ", " + which + " part (" + number_text(typical, range) + ")";
      index = static_cast<std::size_t>(std::ranges::find(tissues, name, &Tissue::name) - tissues.begin());
      if (index < tissues.size()) continue;
      tissues.push_back({name, readable(side.low, range), readable(side.high, range), readable(side.softness, range)});
      suggestion.typical.push_back(typical);
    }
    suggestion.boundaries.push_back(
        {.low = low, .high = high, .middle = 0.5 * (wall.low + wall.high), .share = wall.share, .within = tissue});
    noise_gradients.push_back(wall.noise_gradient);
  }
}

/// Factors that set in at the boundary's middle, on the way up or on the way down.
TransferFunction beyond_the_middle(const FoundBoundary& boundary, double step, double factor, bool up) {
  const double way = up ? step : -step;
  std::vector<Node> nodes{{readable(boundary.middle - 0.08 * way, step), 0},
                          {readable(boundary.middle + 0.02 * way, step), factor}};
  if (!up) std::swap(nodes[0], nodes[1]);
  return TransferFunction(std::move(nodes));
}

Mode surface_for(const FoundBoundary& boundary, const Suggestion& suggestion, const std::string& name, double scale_mm,
                 bool is_ct, double noise_gradient, bool up) {
  const double step = suggestion.typical[boundary.high] - suggestion.typical[boundary.low];
  // Steepest gradient of a step at a scale.
  const double peak = step / (scale_mm * std::sqrt(2 * std::numbers::pi));
  const bool is_hard = is_ct && boundary.within.empty() && suggestion.typical[boundary.high] > least_bone_hu;
  Mode mode;
  mode.type = "surface";
  mode.from = suggestion.scene.tissues[up ? boundary.low : boundary.high].name;
  mode.to = suggestion.scene.tissues[up ? boundary.high : boundary.low].name;
  mode.enabled = up;
  mode.name = up ? name : way_back_name(name);
  mode.strength_of = Datum::gradient_magnitude;
  // What noise alone may be is not felt.
  const double from = std::max(ramp_from * peak, least_in_noise * noise_gradient);
  mode.strength_n = TransferFunction({{readable(from, infinity), 0},
                                      {readable(std::max(ramp_to * peak, 1.5 * from), infinity),
                                       is_hard ? defaults::bone_strength_n : defaults::skin_strength_n}});
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

/// Where the edges lie whose two sides are within the boundary's two tissues.
SiteCounts sites_of(const FoundBoundary& boundary, const Suggestion& suggestion, const internal::EdgeSites& sites) {
  const io::Bins& values = suggestion.edges.values;
  const Tissue &low = suggestion.scene.tissues[boundary.low], &high = suggestion.scene.tissues[boundary.high];
  return sites.count(values.bin_of(low.low), values.bin_of(low.high) + 1, values.bin_of(high.low),
                     values.bin_of(high.high) + 1);
}

/// Each its tissue's; those of a tissue that another has already been given the color of, one that is left.
std::vector<const char*> colors_for(const std::vector<std::string>& names) {
  std::vector<const char*> colors(names.size(), nullptr);
  std::vector<const char*> left(tissue_colors.begin(), tissue_colors.end());
  for (std::size_t n = 0; n < names.size(); ++n) {
    const auto own = std::ranges::find(left, color_of(kind_of(names[n])));
    if (own == left.end()) continue;
    colors[n] = *own;
    left.erase(own);
  }
  for (const char*& color : colors) {
    if (color != nullptr) continue;
    color = left.back();
    left.pop_back();
  }
  return colors;
}

/// A surface for each boundary, then the ways back, then the friction of the outermost of the first `between_tissues`
/// boundaries: the others are faint walls. `noise_gradients`: of each boundary.
void add_modes(Suggestion& suggestion, std::size_t between_tissues, const std::vector<double>& noise_gradients,
               const NamingOptions& naming, double scale_mm) {
  const bool is_ct = naming.hounsfield;
  std::vector<FoundBoundary>& boundaries = suggestion.boundaries;
  std::vector<NamedPair> pairs;
  pairs.reserve(boundaries.size());
  for (const FoundBoundary& boundary : boundaries) {
    pairs.push_back(
        {suggestion.typical[boundary.low], suggestion.typical[boundary.high], boundary.within, boundary.sites});
  }
  const std::vector<std::string> names = boundary_names(pairs, naming);
  const std::vector<const char*> colors = colors_for(names);
  std::vector<Mode>& modes = suggestion.scene.modes;
  for (const bool up : {true, false}) {
    for (std::size_t b = 0; b < boundaries.size(); ++b) {
      (up ? boundaries[b].mode : boundaries[b].way_back) = modes.size();
      modes.push_back(surface_for(boundaries[b], suggestion, names[b], scale_mm, is_ct, noise_gradients[b], up));
      modes.back().color = colors[b];
    }
  }
  if (between_tissues == 0) return;
  const auto faint = boundaries.begin() + static_cast<std::ptrdiff_t>(between_tissues);
  const auto outermost = std::min_element(boundaries.begin(), faint,
                                          [](const auto& one, const auto& other) { return one.middle < other.middle; });
  modes.push_back(friction_above(*outermost, suggestion));
}

}  // namespace

Suggestion suggest(const std::shared_ptr<const io::Volume>& volume, const io::Progress& progress, int threads) {
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  const io::GradientKernel kernel(volume, scale_mm);
  const internal::ScanNoise noise(*volume, kernel, threads);
  const internal::Spread& spread = noise.spread();
  const double range = spread.high - spread.low;
  Suggestion suggestion;
  suggestion.scene.name = "Suggested for this " + (volume->modality.empty() ? "scan" : volume->modality);
  if (!(range > 0)) {
    suggestion.scene.description = "The scan has one value only, and no boundary.";
    return suggestion;
  }
  constexpr double least_range = 1e-15, most_range = 1e15;  // beyond, the squares of gradients are no floats
  if (!(range >= least_range && range <= most_range)) {
    suggestion.scene.description = "The values of the scan span " + number_text(range) +
                                   ", too much or too little for a scene: rescale them to another unit.";
    return suggestion;
  }
  const double steepest_of_least = least_step * range / (scale_mm * std::sqrt(2 * std::numbers::pi));
  const std::array least_gradients{steepest_of_least, internal::least_gradient_of_walls(noise, scale_mm)};
  const bool is_ct = volume->unit == "HU";
  std::optional<internal::Regions> regions;
  std::optional<internal::EdgeSites> edge_sites;
  io::EdgeUse use;
  if (is_ct) {
    regions.emplace(*volume, threads);
    edge_sites.emplace(*volume, *regions, internal::reach_of_sides * scale_mm);
    use = [&](std::span<const io::CountedEdge> counted) { edge_sites->add(counted); };
  }
  std::vector<io::LowHighHistogram> edges =
      io::low_high_histograms(*volume, kernel, {spread.low - margin * range, spread.high + margin * range, value_bins},
                              least_gradients, progress, threads, use);
  suggestion.edges = std::move(edges[0]);
  const TissueHills found =
      internal::tissue_hills(suggestion.edges, {0, value_bins}, bins_of_least_step(suggestion.edges.values),
                             std::max(bandwidth_of_range * range, 0.75 * spread.noise), is_ct);
  suggestion.typical = found.typical;
  suggestion.scene.tissues = tissues_of(found, suggestion.edges.values, *volume);
  const PairCounts counts = count_pairs(found, suggestion.edges);
  suggestion.boundaries = boundaries_of(found, counts, is_ct);
  if (is_ct) internal::merge_boundaries(suggestion.boundaries, suggestion);
  suggestion.boundaries.resize(std::min(suggestion.boundaries.size(), most_boundaries));
  std::vector<double> limits, noise_gradients(suggestion.boundaries.size());
  for (std::size_t t = 1; t < found.hills.size(); ++t) limits.push_back(suggestion.scene.tissues[t].low);
  const std::size_t between_tissues = suggestion.boundaries.size();
  add_faint_walls(internal::faint_walls(edges[1], found, noise.between(limits), range, counts.all, is_ct), range,
                  suggestion, noise_gradients);
  if (edge_sites) {
    for (FoundBoundary& boundary : suggestion.boundaries) boundary.sites = sites_of(boundary, suggestion, *edge_sites);
  }
  double darkest_end = infinity;
  for (std::size_t b = 0; b < between_tissues; ++b)
    darkest_end = std::min(darkest_end, suggestion.boundaries[b].middle);
  const bool is_head = !is_ct && between_tissues > 0 && internal::is_built_like_a_head(*volume, darkest_end);
  add_modes(suggestion, between_tissues, noise_gradients, {is_ct, is_head, range}, scale_mm);
  suggestion.scene.description =
      "Tissues and boundaries as they were found in the scan: rename, switch and reshape them.";
  return suggestion;
}

}  // namespace palpate::modes
