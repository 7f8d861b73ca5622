#pragma once

#include <cstdint>

namespace palpate::io::internal {

/// Whether the reader parses this attribute (group << 16 | element) of a dataset. Attributes inside a sequence are
/// parsed with the sequence. Reading an attribute that is not in this list throws std::logic_error (dicom_value.h); add
/// it here.
bool is_asked_for(std::uint32_t tag);

/// The same for the reader of structures (io/structures), which reads more of segmentations and contours than of
/// images.
bool is_asked_for_of_structures(std::uint32_t tag);

/// The same for the reader of registrations. The list is short, because every file beside a structure is read with
/// it.
bool is_asked_for_of_registrations(std::uint32_t tag);

}  // namespace palpate::io::internal
