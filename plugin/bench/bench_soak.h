#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench soak [--minutes M] [--clock]`: an hour of probing with repeated changes and faults (soak.h).
void add_bench_soak(CLI::App& bench);

}  // namespace palpate::plugin
