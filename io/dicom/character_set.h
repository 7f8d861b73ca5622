#pragma once

#include <string>

namespace palpate::io::internal {

/// Text in a dataset's character set (SpecificCharacterSet, all its values) as UTF-8. What cannot be converted is taken
/// for Latin-1.
std::string utf8_of(const std::string& text, const std::string& character_set);

}  // namespace palpate::io::internal
