#pragma once

#include <cstdint>

namespace palpate::io::internal {

/// Whether the reader of images uses this attribute (group << 16 | element) of a dataset. No other attributes are
/// parsed; a sequence is parsed with all that it holds. Reading another attribute throws std::logic_error
/// (dicom_value.h): add it here.
bool is_asked_for(std::uint32_t tag);

/// The same for the reader of structures (io/structures), which uses more attributes.
bool is_asked_for_of_structures(std::uint32_t tag);

/// The same for the reader of registrations: few attributes, since it reads all files beside a structure.
bool is_asked_for_of_registrations(std::uint32_t tag);

}  // namespace palpate::io::internal
