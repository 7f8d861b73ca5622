#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate::io {

/// A DIMSE status in words: "the archive is out of resources (status A700)". DICOM PS3.7 Annex C, PS3.4 B.2.3 and C.4.
std::string status_words(std::uint16_t status);

/// A peer's text made safe to show: at most 64 printable ASCII characters.
std::string printable(std::string_view text);

}  // namespace palpate::io
