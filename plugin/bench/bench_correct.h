#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench correct`: what an edit of an outline costs, and whether touch helps a simulated hand to correct one.
void add_bench_correct(CLI::App& bench);

}  // namespace palpate::plugin
