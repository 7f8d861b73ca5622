#pragma once

#include <string>

namespace palpate::io::internal {

/// Text in a dataset's character set (SpecificCharacterSet, all its values) as UTF-8. Text that cannot be converted is
/// read as Latin-1.
std::string utf8_of(const std::string& text, const std::string& character_set);

}  // namespace palpate::io::internal
