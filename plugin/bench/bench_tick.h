#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench tick SERIES [-o DIR]`: the time of a tick on a scan, stage by stage, and its growth with modes,
/// primitives and the volume's size; `--sphere`: a hand on a sphere of known shape: the force's direction, its jitter
/// at rest, and the time.
void add_bench_tick(CLI::App& bench);

}  // namespace palpate::plugin
