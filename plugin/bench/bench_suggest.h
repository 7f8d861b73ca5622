#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench suggest [SERIES] [--rounds N]`: the time to find the tissues of a scan, compared with one pass of the
/// gradient over it and with one read of its voxels; on one core and on all. Without a series: noisy balls of growing
/// size.
void add_bench_suggest(CLI::App& bench);

}  // namespace palpate::plugin
