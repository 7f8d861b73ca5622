#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench structures [SERIES --structures PATH]`: how true the surfaces of labels are; how fast a hundred of
/// them are listed and ready; and on a scan what five of them add to a tick.
void add_bench_structures(CLI::App& bench);

}  // namespace palpate::plugin
