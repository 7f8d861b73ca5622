#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench solvers [--cases N] [-o DIR]`: every solver on every family of solver/testing/problems.h: error
/// against a 128-bit reference, and run time; run time against the number of primitives; and the paper's Table 1 beside
/// our own. Printed as tables, and with -o written as CSV and pictures.
void add_bench_solvers(CLI::App& bench);

}  // namespace palpate::plugin
