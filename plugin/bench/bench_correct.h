#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench correct`: the time of an edit of an outline, and whether touch helps a simulated hand to correct one.
void add_bench_correct(CLI::App& bench);

}  // namespace palpate::plugin
