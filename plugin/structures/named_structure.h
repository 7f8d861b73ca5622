#pragma once

/// The structure of a file that a number or a name asks for.

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "io/structures/structure.h"

namespace palpate::plugin {

/// The number, the name, or both, by which a structure is asked for. The name counts only if no structure has the
/// number.
struct AskedStructure {
  std::optional<int> number;
  std::optional<std::string> name;
};

/// A text of digits is a number, and may be a name.
AskedStructure asked_structure(const std::string& text);

struct FoundStructure {
  const io::Structure* structure = nullptr;
  Text why_not;  ///< if it is null: no structure is meant, or several are
};
/// `file`: the file or folder that the structures were found in.
FoundStructure find_named(std::span<const io::Structure> structures, const AskedStructure& asked,
                          const std::filesystem::path& file);

/// Numbers and names, as a message lists them: "1 Liver, 2 Spleen".
std::string listed(std::span<const io::Structure> structures);

}  // namespace palpate::plugin
