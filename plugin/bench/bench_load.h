#pragma once

namespace CLI {
class App;
}

namespace palpate::plugin {

/// `palpate-bench load FOLDER... [--rounds N] [--jpeg-lossless]`: time from a folder to a volume with its minimum,
/// maximum and mean, against DCMTK, GDCM and dcm2niix if they are installed. Each runs in its own process, alternately,
/// with a warm page cache. Prints medians, and the exact calls.
void add_bench_load(CLI::App& bench);

}  // namespace palpate::plugin
