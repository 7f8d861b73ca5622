#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Adds `palpate-bench waits`.
void add_bench_waits(CLI::App& bench);

}  // namespace palpate::plugin
