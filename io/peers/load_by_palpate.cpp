// load_by_palpate FOLDER: only find_series(), load() and statistics(), to be compared with the other libraries in
// `palpate-bench load`.
#include <array>
#include <cstdio>
#include <filesystem>

#include "io/load.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  const palpate::io::Catalogue found = palpate::io::find_series(std::array{folder});
  if (found.series.empty()) return 1;
  const palpate::io::Volume volume = palpate::io::load(found.series.front());
  const palpate::io::Statistics values = palpate::io::statistics(volume);
  std::printf("%d slices, %g to %g, mean %.9g\n", volume.geometry.dimensions.z, values.minimum, values.maximum,
              values.mean);
}
