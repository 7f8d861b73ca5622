#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench structures [SERIES --structures PATH]`: the accuracy of the surfaces of labels; the time to list and
/// prepare a hundred of them; and on a scan the time that five of them add to a tick.
void add_bench_structures(CLI::App& bench);

}  // namespace palpate::plugin
