#include "plugin/cli/output_files.h"

#include <algorithm>
#include <system_error>

#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

/// Whether both are one file. Files that are not there yet are compared by their paths.
bool is_one_file(const fs::path& a, const fs::path& b) {
  std::error_code absent;
  if (fs::equivalent(a, b, absent)) return true;
  const fs::path whole = fs::weakly_canonical(a, absent);
  return !whole.empty() && whole == fs::weakly_canonical(b, absent);
}

}  // namespace

void check_outputs(const std::vector<fs::path>& outputs, const std::vector<fs::path>& inputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    if (output->empty()) continue;
    const auto is_it = [&](const fs::path& other) { return !other.empty() && is_one_file(*output, other); };
    if (std::ranges::any_of(inputs, is_it)) throw InputRefused(say("output-is-an-input", output->string()));
    if (std::any_of(outputs.begin(), output, is_it)) throw InputRefused(say("outputs-are-one-file", output->string()));
  }
}

std::vector<fs::path> files_read(const io::Series& series, const modes::Scene& scene) {
  std::vector<fs::path> files = series.files;
  for (const modes::SceneStructure& structure : scene.structures) files.emplace_back(structure.file);
  return files;
}

}  // namespace palpate::plugin
