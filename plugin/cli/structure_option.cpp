#include "plugin/cli/structure_option.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "io/errors.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/messages/messages.h"
#include "plugin/structures/named_structure.h"
#include "plugin/structures/study_registrations.h"
#include "plugin/structures/study_structures.h"
#include "solver/text/printable.h"

namespace palpate::plugin {
namespace {

struct NamedStructure {
  std::filesystem::path file;
  std::string segment;  ///< empty: the file's only one
};

/// FILE or FILE:SEGMENT. Both may contain colons: the file is the longest part that exists.
NamedStructure split(const std::string& text) {
  std::error_code ignored;
  if (std::filesystem::exists(text, ignored)) return {text, {}};
  const std::size_t last = text.rfind(':');
  for (std::size_t colon = last; colon != std::string::npos && colon > 0; colon = text.rfind(':', colon - 1)) {
    const std::string file = text.substr(0, colon);
    if (std::filesystem::exists(file, ignored)) return {file, text.substr(colon + 1)};
  }
  if (last == std::string::npos) return {text, {}};
  return {text.substr(0, last), text.substr(last + 1)};  // whichever is named in the refusal
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
  if (!segment.empty()) {
    const FoundStructure one = find_named(found.structures, asked_structure(segment), file);
    if (one.structure == nullptr) throw InputRefused(one.why_not);
    return *one.structure;
  }
  if (found.structures.size() > 1) {
    throw WrongUsage(say("file-holds-several-structures", name, name, listed(found.structures)));
  }
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
