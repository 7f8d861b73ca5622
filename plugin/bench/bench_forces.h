#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench forces [SERIES --structures PATH] [--paths N] [--seed N] [-o DIR]`: the error of the felt force along
/// random straight paths.
void add_bench_forces(CLI::App& bench);

}  // namespace palpate::plugin
