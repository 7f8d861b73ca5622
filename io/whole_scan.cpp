#include "io/whole_scan.h"

#include <algorithm>
#include <string>

#include "io/interchange/voxel_file.h"
#include "io/unpack.h"

namespace palpate::io {

bool holds_whole_scans(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  const auto ends = [&](const std::string& ending) { return has_ending(file, ending); };
  return std::ranges::any_of(label_format_endings(), ends) || (internal::is_archive(file) && !ends(".dcm.gz"));
}

}  // namespace palpate::io
