#pragma once

/// The accuracy of the scan's own edge beside the surface of labels: `palpate-bench structures`.

#include <string>

namespace palpate::plugin {

/// Balls as in CT, with partial volume, blur and noise; their labels are the values above the middle. Prints the errors
/// of the labels' surface and of the scan's own edge beside it, and returns them as CSV.
std::string tabulate_own_edges();

}  // namespace palpate::plugin
