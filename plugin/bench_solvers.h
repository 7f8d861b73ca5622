#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate bench solvers [--cases N] [-o DIR]`: error against run time, every family of solver/problems.h by every
/// solver, as a table and, with -o, as CSV and a picture.
void add_bench_solvers(CLI::App& bench);

}  // namespace palpate::plugin
