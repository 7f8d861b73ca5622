#include "plugin/paraview/client/scan/scan_look.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

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

VolumeLook skin_and_bone() {
  return {"Skin and bone",
          {-1000, 0.3, 0.15, 0.1, -300, 0.75, 0.5,  0.4, 100,  0.8,  //
           0.4,   0.3, 300,  0.9, 0.8,  0.65, 1200, 1,   0.97, 0.9},
          {-1000, 0, 0.5, 0, -400, 0, 0.5, 0,   -250, 0.03, 0.5,  0,   100, 0,
           0.5,   0, 180, 0, 0.5,  0, 500, 0.5, 0.5,  0,    1500, 0.9, 0.5, 0}};
}

VolumeLook bone() {
  return {"Bone",
          {100, 0.8, 0.4, 0.3, 300, 0.9, 0.8, 0.65, 1200, 1, 0.97, 0.9},
          {150, 0, 0.5, 0, 500, 0.5, 0.5, 0, 1500, 0.9, 0.5, 0}};
}

VolumeLook lungs() {
  return {"Lungs",
          {-1000, 0.1, 0.2, 0.3, -800, 0.55, 0.7, 0.8, -500, 0.85, 0.6, 0.55, 100, 0.8, 0.4, 0.3, 400, 1, 0.97, 0.9},
          {-1000, 0, 0.5,  0, -950, 0, 0.5, 0, -800, 0.02, 0.5, 0,    -600, 0.06,
           0.5,   0, -450, 0, 0.5,  0, 200, 0, 0.5,  0,    600, 0.35, 0.5,  0}};
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
    windows.insert(windows.end(),
                   {{"Soft tissue", {40, 400}}, {"Brain", {40, 80}}, {"Lung", {-600, 1500}}, {"Bone", {480, 2500}}});
  } else {
    const auto& shares = values.shares;
    if (shares.size() > 2) {
      const std::size_t end = shares.size() - 1;
      windows.push_back({"Middle 98 %", from_to(shares[end / 100], shares[end - end / 100])});
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

VolumeLook volume_look_for(const Values& values) {
  const auto& shares = values.shares;
  if (values.hounsfield) {
    if (shares.empty()) return skin_and_bone();
    constexpr double air = -950, lung = -600, tissue = -300;
    const double as_light_as_lungs = part_below(shares, lung) - part_below(shares, air);
    const double in_the_body = 1 - part_below(shares, air);
    if (as_light_as_lungs > 0.1 * in_the_body && as_light_as_lungs > 0.02) return lungs();
    return part_below(shares, tissue) > 0 ? skin_and_bone() : bone();
  }
  if (shares.size() < 100) {
    const double range = values.high - values.low;
    return brighter_than("Tissue", values.low + 0.15 * range, values.low + 0.6 * range, values.high, 0.6);
  }
  const double threshold = otsu_threshold(shares);
  const double bright = shares[shares.size() - 2];
  constexpr double few = 0.04;
  if (1 - part_below(shares, threshold) < few) return brighter_than("Vessels", threshold, bright, values.high, 0.9);
  return brighter_than("Tissue", threshold, bright, values.high, 0.5);
}

}  // namespace palpate::plugin
