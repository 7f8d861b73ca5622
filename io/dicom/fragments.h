#pragma once

/// Encapsulated (compressed) pixel data: DICOM PS3.5 annex A.4. A frame is one fragment or several in a row.

#include <cstdint>
#include <vector>

#include "io/dicom/input_file.h"

namespace palpate::io::internal {

struct Fragment {
  std::uint64_t at = 0;  ///< in the file
  std::uint32_t length = 0;
};

struct Encapsulated {
  std::vector<std::vector<Fragment>> frames;  ///< the fragments of each
  bool has_end = true;  ///< whether the item that ends them is there; the fragments are complete without it
};

/// The fragments of each frame. `pixels_at` is where the value of PixelData starts, at the basic offset table. Frames
/// are one fragment each if the numbers agree; else the offset table divides them; else a frame begins with each
/// fragment that begins a JPEG, JPEG-LS or JPEG 2000 stream. Throws DicomError if the file is truncated or the
/// fragments do not give that many frames.
Encapsulated find_fragments(const InputFile& file, std::uint64_t pixels_at, std::size_t frames);

/// The bytes of a frame, its fragments joined.
std::vector<std::byte> read_fragments(const InputFile& file, const std::vector<Fragment>& fragments);

}  // namespace palpate::io::internal
