#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench solvers [--cases N] [-o DIR]`: error against a 128-bit reference against run time, every family of
/// solver/testing/problems.h by every solver; run time against the number of primitives; and the paper's Table 1 beside
/// ours. As tables and, with -o, as CSV and pictures.
void add_bench_solvers(CLI::App& bench);

}  // namespace palpate::plugin
