#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench subdivision [-o DIR]`: what cutting a tick into sub-steps buys on a curved wall, in error against
/// run time, over stylus speeds.
void add_bench_subdivision(CLI::App& bench);

}  // namespace palpate::plugin
