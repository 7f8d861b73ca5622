#pragma once

/// How the filters of a scan change what is felt: `palpate-bench fields --filters`.

#include <string>

namespace palpate::plugin {

/// For each filter: the roughness of a flat noisy wall, how far it shifts a flat and a round boundary, and the time
/// that it takes. Prints the table and returns it as CSV.
std::string run_filter_study();

}  // namespace palpate::plugin
