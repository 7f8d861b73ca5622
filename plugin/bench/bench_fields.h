#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench fields [SERIES] [-o DIR]`: what the gradient's direction and magnitude cost and are worth, on
/// phantoms with known answers and, where a series is named, the jitter of its direction under a resting hand.
void add_bench_fields(CLI::App& bench);

}  // namespace palpate::plugin
