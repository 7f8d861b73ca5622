#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench soak [--minutes M] [--clock]`: an hour of probing in which everything happens again and again.
void add_bench_soak(CLI::App& bench);

}  // namespace palpate::plugin
