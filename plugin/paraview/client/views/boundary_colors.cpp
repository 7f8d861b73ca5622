#include "plugin/paraview/client/views/boundary_colors.h"

#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "modes/types/mode_type.h"
#include "plugin/paraview/client/words/mode_words.h"

namespace palpate::plugin {
namespace {

constexpr double closest = 1e-3;  // of the whole range: nodes nearer to each other take tables that are too large

struct Coat {
  double value = 0;
  QColor color;
  double opacity = 0;
};

}  // namespace

double felt_value(const modes::Mode& mode) {
  for (const modes::Gate& gate : mode.gates) {
    if (gate.of != modes::Datum::value) continue;
    const auto nodes = gate.factor.nodes();
    for (std::size_t n = 1; n < nodes.size(); ++n) {
      const double a = nodes[n - 1].value, b = nodes[n].value;
      if (a < 0.5 && b >= 0.5) return nodes[n - 1].at + (0.5 - a) / (b - a) * (nodes[n].at - nodes[n - 1].at);
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void color_volume(vtkSMProxy& representation, const modes::Scene& scene, double low, double high) {
  std::vector<Coat> coats;
  for (const modes::Mode& mode : scene.modes) {
    const double value = felt_value(mode);
    if (!modes::reads_key(mode, modes::Key::tissues) || !mode.enabled || !(value > low && value < high)) continue;
    coats.push_back({value, color_of(mode), 0});
  }
  vtkSMProxy* const colors = vtkSMPropertyHelper(&representation, "LookupTable").GetAsProxy();
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (coats.empty() || !colors || !opacity) return;
  std::sort(coats.begin(), coats.end(), [](const Coat& a, const Coat& b) { return a.value < b.value; });
  // The outermost is a veil, the innermost solid, so that each is seen through those before it.
  for (std::size_t n = 0; n < coats.size(); ++n) {
    coats[n].opacity = n + 1 == coats.size() ? 0.8 : 0.04 + 0.06 * static_cast<double>(n);
  }
  const double ramp = 0.02 * (high - low);
  std::vector<double> points, rgb;
  const auto add = [&](double value, double part) {
    if (!points.empty() && value <= points[points.size() - 4]) {
      value = points[points.size() - 4] + closest * (high - low);
    }
    points.insert(points.end(), {value, part, 0.5, 0.0});
  };
  add(low, 0);
  for (std::size_t n = 0; n < coats.size(); ++n) {
    const Coat& coat = coats[n];
    const bool last = n + 1 == coats.size();
    const double end = last ? high : std::min(coat.value + 3 * ramp, coats[n + 1].value - ramp);
    add(coat.value - ramp, 0);
    add(coat.value + ramp, coat.opacity);
    if (!last) {
      add(std::max(end, coat.value + 1.5 * ramp), coat.opacity * 0.2);
    } else {
      add(high, coat.opacity);
    }
    const double from = n == 0 ? low : coat.value - ramp;
    for (const double at : {from, last ? high : coats[n + 1].value - 1.1 * ramp}) {
      if (!rgb.empty() && at <= rgb[rgb.size() - 4]) continue;
      rgb.insert(rgb.end(), {at, coat.color.redF(), coat.color.greenF(), coat.color.blueF()});
    }
  }
  vtkSMPropertyHelper(colors, "RGBPoints").Set(rgb.data(), static_cast<unsigned>(rgb.size()));
  vtkSMPropertyHelper(opacity, "Points").Set(points.data(), static_cast<unsigned>(points.size()));
  colors->UpdateVTKObjects();
  opacity->UpdateVTKObjects();
  vtkSMPropertyHelper(&representation, "Shade", true).Set(0);  // the colors are the legend's
  representation.UpdateVTKObjects();
}

std::vector<OpacityNode> opacity_of(vtkSMProxy& representation) {
  vtkSMProxy* const opacity = vtkSMPropertyHelper(&representation, "ScalarOpacityFunction").GetAsProxy();
  if (!opacity) return {};
  // Four numbers a node: value, opacity over the unit distance, and two of how the curve bends.
  const std::vector<double> points = vtkSMPropertyHelper(opacity, "Points").GetDoubleArray();
  const double unit_mm = vtkSMPropertyHelper(&representation, "ScalarOpacityUnitDistance", true).GetAsDouble();
  std::vector<OpacityNode> nodes;
  for (std::size_t n = 0; n + 3 < points.size(); n += 4) {
    const double passes = std::clamp(1 - points[n + 1], 0.0, 1.0);
    nodes.push_back({points[n], 1 - std::pow(passes, unit_mm > 0 ? 1 / unit_mm : 1)});
  }
  return nodes;
}

}  // namespace palpate::plugin
