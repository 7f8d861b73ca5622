#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench suggest [SERIES] [--rounds N]`: what finding the tissues of a scan takes, beside one pass of the
/// gradient over it and one read of its voxels; on one core and on all. Without a series: balls with noise, of growing
/// size.
void add_bench_suggest(CLI::App& bench);

}  // namespace palpate::plugin
