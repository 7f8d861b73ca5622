#pragma once

#include <cstdint>

namespace palpate::io::internal {

/// Whether the reader asks for this attribute (group << 16 | element) of a dataset: no others are parsed. What lies in
/// a sequence goes with it. Asking for another one throws std::logic_error (dicom_value.h): add it here.
bool is_asked_for(std::uint32_t tag);

/// Whether the reader of structures (io/structures) asks for it: of segmentations and contours more than of images.
bool is_asked_for_of_structures(std::uint32_t tag);

/// Whether the reader of registrations asks for it: few, for all files beside a structure are read so.
bool is_asked_for_of_registrations(std::uint32_t tag);

}  // namespace palpate::io::internal
