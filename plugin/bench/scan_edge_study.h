#pragma once

/// What the scan's own values give beside the surface of labels: `palpate-bench structures`.

#include <string>

namespace palpate::plugin {

/// Balls as a CT shows them, with partial volume, blur and noise, and with labels that are its values above the middle.
/// Prints the errors of the labels' surface and of the scan's own edge beside it; returns them as CSV.
std::string tabulate_own_edges();

}  // namespace palpate::plugin
