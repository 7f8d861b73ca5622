#include "modes/scene/met_values.h"

#include <algorithm>

namespace palpate::modes {

double value_factor(const Mode& mode, double value) {
  double factor = 1;
  for (const Gate& gate : mode.gates) {
    if (gate.of == Datum::value) factor *= gate.factor(value);
  }
  return factor;
}

std::vector<double> met_values(const Mode& mode, Side side) {
  std::vector<double> at;
  for (const Gate& gate : mode.gates) {
    if (gate.of != Datum::value) continue;
    for (const Node& node : gate.factor.nodes()) at.push_back(node.at);
  }
  std::sort(at.begin(), at.end());
  double largest = 0;
  for (const double value : at) largest = std::max(largest, value_factor(mode, value));
  std::vector<double> met;
  if (!(largest > 0)) return met;
  for (std::size_t n = 1; n < at.size(); ++n) {
    double low = at[n - 1], high = at[n];
    const bool begins = value_factor(mode, low) < largest / 2, ends = value_factor(mode, high) < largest / 2;
    const bool rises = begins && !ends, falls = ends && !begins;
    if (!(rises && side != Side::leaving) && !(falls && side != Side::entering)) continue;
    constexpr int halvings = 40;  // the factor is a curve of any form
    for (int step = 0; step < halvings; ++step) {
      const double middle = 0.5 * (low + high);
      ((value_factor(mode, middle) < largest / 2) == begins ? low : high) = middle;
    }
    met.push_back(0.5 * (low + high));
  }
  return met;
}

}  // namespace palpate::modes
