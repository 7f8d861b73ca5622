#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench tick SERIES [-o DIR]`: what a tick costs on a scan, stage by stage, and how that grows with modes,
/// primitives and the volume's size; `--sphere`: a hand on a sphere of known shape, its direction, its rest and its
/// time.
void add_bench_tick(CLI::App& bench);

}  // namespace palpate::plugin
