#pragma once

/// Encapsulated (compressed) pixel data: DICOM PS3.5 annex A.4. A frame is one fragment or several consecutive ones.

#include <cstdint>
#include <vector>

#include "io/dicom/input_file.h"

namespace palpate::io::internal {

struct Fragment {
  std::uint64_t at = 0;  ///< in the file
  std::uint32_t length = 0;
};

struct Encapsulated {
  std::vector<std::vector<Fragment>> frames;  ///< the fragments of each frame
  bool has_end = true;  ///< whether the item that ends the fragments is present; they are usable without it
};

/// The fragments of each frame. `pixels_at` is the offset of PixelData's value, which starts with the basic offset
/// table. If there are as many fragments as frames, each fragment is a frame. Otherwise the offset table gives the
/// first fragment of each frame. If it is missing or inconsistent, a frame begins at each fragment that starts a new
/// JPEG, JPEG-LS or JPEG 2000 stream. Throws DicomError if the file is truncated or the fragments do not make up that
/// many frames.
Encapsulated find_fragments(const InputFile& file, std::uint64_t pixels_at, std::size_t frames);

/// The bytes of a frame, its fragments joined.
std::vector<std::byte> read_fragments(const InputFile& file, const std::vector<Fragment>& fragments);

}  // namespace palpate::io::internal
