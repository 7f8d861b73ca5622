#pragma once

/// The values at which a boundary begins to be felt.

#include <vector>

#include "modes/scene/plan.h"
#include "modes/scene/scene.h"

namespace palpate::modes {

/// The product of a mode's gates over value.
double value_factor(const Mode& mode, double value);

/// The values at which a surface begins to be felt from the side that it resists: there the product of its gates over
/// value reaches half of its largest factor. Empty for a mode without a gate over value.
std::vector<double> met_values(const Mode& mode, Side side);

}  // namespace palpate::modes
