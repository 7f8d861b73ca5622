#pragma once

/// The effect of the filters of a scan on the felt force: `palpate-bench fields --filters`.

#include <string>

namespace palpate::plugin {

/// For each filter: the roughness of a flat noisy wall, the shift of a flat and a round boundary, and the filter's run
/// time. Prints the table and returns it as CSV.
std::string run_filter_study();

}  // namespace palpate::plugin
