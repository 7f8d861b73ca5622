#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench subdivision [-o DIR]`: the benefit of dividing a tick into sub-steps on a curved wall: error against
/// run time, for several stylus speeds.
void add_bench_subdivision(CLI::App& bench);

}  // namespace palpate::plugin
