#include "modes/scene/boundary.h"

#include <cmath>
#include <vector>

namespace palpate::modes {
namespace {

// Orders tissues by where they lie, open ends included.
double middle(const Tissue& tissue) {
  if (std::isinf(tissue.low) && std::isinf(tissue.high)) {
    return 0.0;
  }
  return std::isinf(tissue.low)
             ? tissue.high - tissue.softness
             : (std::isinf(tissue.high) ? tissue.low + tissue.softness : 0.5 * (tissue.low + tissue.high));
}

}  // namespace

TransferFunction gate_of(const Tissue& tissue) {
  const double half = 0.5 * tissue.softness;
  std::vector<Node> nodes;
  if (std::isfinite(tissue.low)) {
    nodes.push_back({tissue.low - half, 0.0});
    nodes.push_back({tissue.low + half, 1.0});
  }
  if (std::isfinite(tissue.high)) {
    if (nodes.empty() || tissue.high - half > nodes.back().at) {
      nodes.push_back({tissue.high - half, 1.0});
    }
    nodes.push_back({tissue.high + half, 0.0});
  }
  return nodes.empty() ? TransferFunction(1.0) : TransferFunction(std::move(nodes));
}

Boundary boundary_between(const Tissue& from, const Tissue& to) {
  const bool upwards = middle(to) > middle(from);
  const Tissue& low = upwards ? from : to;
  const Tissue& high = upwards ? to : from;
  return {{Gate{Datum::low, gate_of(low)}, Gate{Datum::high, gate_of(high)}}, upwards ? Side::entering : Side::leaving};
}

}  // namespace palpate::modes
