#include "plugin/paraview/common/scan_look.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace palpate::plugin {
namespace {

/// Part of the voxels with a value below this one.
double part_below(const std::vector<double>& shares, double value) {
  const auto at = std::ranges::lower_bound(shares, value) - shares.begin();
  return static_cast<double>(at) / static_cast<double>(shares.size());
}

Window from_to(double low, double high) {
  return {(low + high) / 2, std::max(high - low, 1e-3)};
}

VolumeLook skin() {
  return {"CT skin",
          {-600, 0.55, 0.35, 0.28, -250, 0.87, 0.66, 0.55, 100, 0.95, 0.78, 0.68, 400, 1, 0.95, 0.88},
          {-1000, 0, 0.5, 0, -450, 0, 0.5, 0, -250, 0.35, 0.5, 0, -100, 0.8, 0.5, 0, 3000, 1, 0.5, 0}};
}

VolumeLook bone() {
  return {"CT bone",
          {100, 0.72, 0.42, 0.32, 300, 0.9, 0.8, 0.65, 1200, 1, 0.97, 0.9},
          {150, 0, 0.5, 0, 300, 0.25, 0.5, 0, 500, 0.7, 0.5, 0, 1500, 0.95, 0.5, 0}};
}

VolumeLook lung() {
  return {"CT lung",
          {-1000, 0.1, 0.2, 0.3, -800, 0.55, 0.7, 0.8, -500, 0.85, 0.6, 0.55, 100, 0.8, 0.4, 0.3, 400, 1, 0.97, 0.9},
          {-1000, 0, 0.5,  0, -950, 0, 0.5, 0, -800, 0.02, 0.5, 0,    -600, 0.06,
           0.5,   0, -450, 0, 0.5,  0, 200, 0, 0.5,  0,    600, 0.35, 0.5,  0}};
}

/// Filled with contrast: brighter than soft tissue, and mostly darker than dense bone.
VolumeLook vessels() {
  return {
      "CT vessels",
      {130, 0.55, 0.1, 0.08, 250, 0.85, 0.25, 0.18, 450, 0.95, 0.6, 0.45, 700, 0.95, 0.88, 0.75, 1500, 1, 0.97, 0.9},
      {130, 0, 0.5, 0, 200, 0.2, 0.5, 0, 350, 0.7, 0.5, 0, 700, 0.75, 0.5, 0, 1500, 0.9, 0.5, 0}};
}

VolumeLook brighter_than(const char* name, double threshold, double bright, double high, double most) {
  const double step = std::max(bright - threshold, 1e-6);
  return {name,
          {threshold, 0.45, 0.2, 0.15, threshold + 0.4 * step, 0.8, 0.5, 0.4, threshold + step, 1, 0.97, 0.9},
          {threshold, 0, 0.5, 0, threshold + 0.4 * step, 0.25 * most, 0.5, 0, threshold + step, most, 0.5, 0,
           std::max(high, threshold + 1.01 * step), most, 0.5, 0}};
}

}  // namespace

std::vector<NamedWindow> windows_for(const Values& values) {
  std::vector<NamedWindow> windows;
  if (values.own) windows.push_back({"As the scanner set it", *values.own});
  if (values.hounsfield) {
    windows.insert(windows.end(), {{"Soft tissue", {40, 400}},
                                   {"Brain", {40, 80}},
                                   {"Lung", {-600, 1500}},
                                   {"Bone", {480, 2500}},
                                   {"Mediastinum", {50, 350}},
                                   {"Abdomen", {60, 400}},
                                   {"Angio", {300, 600}},
                                   {"Stroke", {40, 40}}});
  } else {
    const auto& shares = values.shares;
    if (shares.size() > 2) {
      const std::size_t end = shares.size() - 1;
      const double low = shares[end / 100], high = shares[end - end / 100];
      if (values.speeds && low >= 0) {
        windows.push_back({"Speed", from_to(0, 2 * high)});
        windows.push_back({"All values", from_to(0, values.high)});  // some say -1e38 where nothing was measured
        return windows;
      }
      windows.push_back({"1st to 99th percentile", from_to(low, high)});
    }
    windows.push_back({"All values", from_to(values.low, values.high)});
  }
  return windows;
}

double otsu_threshold(const std::vector<double>& shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  const auto count = static_cast<double>(shares.size());
  double below = 0;
  double best = -1;
  double threshold = shares.front();
  for (std::size_t n = 1; n < shares.size(); ++n) {
    below += shares[n - 1];
    const auto few = static_cast<double>(n);
    const double apart = below / few - (sum - below) / (count - few);
    const double between = few * (count - few) * apart * apart;
    if (between > best) {
      best = between;
      threshold = (shares[n - 1] + shares[n]) / 2;
    }
  }
  return threshold;
}

namespace {

constexpr double few = 0.04;  // of the voxels: vessels are no more

/// Threshold and brightness from the distribution of values, or from their range if the distribution is unknown.
std::pair<double, double> bright_part(const Values& values) {
  const auto& shares = values.shares;
  if (shares.size() >= 100) return {otsu_threshold(shares), shares[shares.size() - 2]};
  const double range = values.high - values.low;
  return {values.low + 0.15 * range, values.low + 0.6 * range};
}

}  // namespace

std::vector<VolumeLook> volume_looks_for(const Values& values) {
  if (values.hounsfield) return {skin(), bone(), lung(), vessels()};
  const auto [threshold, bright] = bright_part(values);
  const double high = std::max(values.high, bright);
  return {brighter_than("MR", threshold, bright, high, 0.5),
          brighter_than("MR vessels", threshold + 0.4 * (bright - threshold), bright, high, 0.9)};
}

std::size_t suited_look(const Values& values) {
  const auto& shares = values.shares;
  constexpr std::size_t is_skin = 0, is_bone = 1, is_lung = 2, is_mr = 0, is_mr_vessels = 1;
  if (values.hounsfield) {
    if (shares.empty()) return is_skin;
    constexpr double air = -950, light = -600, tissue = -300;
    const double as_light_as_lungs = part_below(shares, light) - part_below(shares, air);
    const double in_the_body = 1 - part_below(shares, air);
    const bool seems_light = as_light_as_lungs > 0.1 * in_the_body && as_light_as_lungs > 0.02;
    if (values.light_part ? *values.light_part > 0.1 : seems_light) return is_lung;
    return part_below(shares, tissue) > 0 ? is_skin : is_bone;
  }
  if (shares.size() < 100) return is_mr;
  return 1 - part_below(shares, otsu_threshold(shares)) < few ? is_mr_vessels : is_mr;
}

}  // namespace palpate::plugin
