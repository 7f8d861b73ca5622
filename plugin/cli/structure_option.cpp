#include "plugin/cli/structure_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "io/errors.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/messages/messages.h"
#include "plugin/structures/study_registrations.h"
#include "plugin/structures/study_structures.h"
#include "solver/text/printable.h"

namespace palpate::plugin {
namespace {

struct NamedStructure {
  std::filesystem::path file;
  std::string segment;  ///< empty: the file's only one
};

NamedStructure split(const std::string& text) {
  std::error_code ignored;
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(text, ignored)) return {text, {}};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace

io::Structure choose_structure(const std::string& text) {
  const auto [file, segment] = split(text);
  const std::string name = file.filename().string();
  const io::StructureCatalogue found = [&, &path = file] {
    try {
      return io::find_structures(std::array{path});
    } catch (const io::DicomError& error) {
      throw InputRefused(error.text());
    }
  }();
  if (found.structures.empty()) {
    const std::string why = found.skipped.empty() ? "" : ": " + found.skipped.front().reason;
    throw InputRefused(say("file-holds-no-structures", name, why));
  }
  std::string known;
  for (const io::Structure& one : found.structures) {
    if (one.name == segment || std::to_string(one.number) == segment) return one;
    known += fmt::format("{}{} {}", known.empty() ? "" : ", ", one.number, one.name);
  }
  if (!segment.empty()) throw InputRefused(say("file-has-no-such-structure", name, segment, known));
  if (found.structures.size() > 1) throw WrongUsage(say("file-holds-several-structures", name, name, known));
  return found.structures.front();
}

io::Structure choose_structure(const std::string& text, const io::Volume& scan) {
  io::Structure structure = choose_structure(text);
  StudyRegistrations beside(terminal_progress("looking for registrations"));
  const Placed placed = place_on(structure, beside.beside(structure, scan), scan);
  if (!placed.why_not.empty()) throw InputRefused(placed.why_not);
  if (const Text off = off_scan(structure, io::box_of(structure), scan.geometry); !off.empty()) throw InputRefused(off);
  for (const Text& warning : structure.warnings) {
    std::fprintf(stderr, "palpate: warning: %s\n", printable(std::string(warning)).c_str());
  }
  return structure;
}

}  // namespace palpate::plugin
