#include "plugin/paraview/client/panel/force_difference.h"

#include <algorithm>
#include <cmath>

namespace palpate::plugin {

bool feels_alike(double a_n, double b_n) {
  return std::abs(a_n - b_n) < weber_fraction * std::max(a_n, b_n);
}

}  // namespace palpate::plugin
