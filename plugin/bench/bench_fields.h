#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench fields [SERIES] [-o DIR]`: run time and accuracy of the gradient's direction and magnitude, on
/// phantoms with known answers and, if a series is named, the jitter of its direction under a resting hand.
void add_bench_fields(CLI::App& bench);

}  // namespace palpate::plugin
