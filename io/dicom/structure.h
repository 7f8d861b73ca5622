#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate::io::internal {

/// How a dataset is written.
struct Encoding {
  bool big_endian = false;
  bool explicit_vr = true;
};

/// Bytes of a dataset, one after the other: of a file as it is, or inflated.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;
  /// Fills `into` as far as there are bytes; returns how many there were.
  virtual std::size_t read(std::span<std::byte> into) = 0;
  /// Moves on; false where the bytes end before that.
  virtual bool skip(std::uint64_t count) = 0;
  /// What is wrong with the bytes where they ended before their end; empty where nothing is.
  virtual std::string damage() const { return {}; }
};

/// The pixel data element of a dataset.
struct PixelElement {
  static constexpr std::uint32_t undefined_length = 0xFFFFFFFF;  ///< compressed pixels, in fragments
  std::uint64_t value_at = 0;                                    ///< bytes of the dataset before its value
  std::uint32_t length = 0;                                      ///< of its value, as claimed
  bool is_float = false;                                         ///< FloatPixelData or DoubleFloatPixelData
  bool is_double = false;                                        ///< the latter
  std::string vr;                                                ///< empty where the dataset has none
};

struct DatasetShape {
  std::uint64_t header_end = 0;  ///< bytes before the pixel data, or before whatever is behind its place, or all
  std::optional<PixelElement> pixels;
  /// Where the outermost elements before the pixels are that somebody wants; what adjoins is one stretch.
  struct Stretch {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
  };
  std::vector<Stretch> wanted;
  bool has_unknown = false;  ///< whether an element is written with the VR UN
};

/// Walks over a dataset up to the place of its pixel data without building anything. Throws DicomError where a parser
/// that does build would overflow its stack (sequences nested deeper than any object defined), run for hours (elements
/// in no order, which is quadratic in DCMTK) or fill the memory (millions of elements), or where the bytes are no
/// elements or end early. `wants` says of a tag (group << 16 | element) whether somebody wants it.
DatasetShape check_structure(ByteSource& dataset, Encoding encoding, bool (*wants)(std::uint32_t tag));

}  // namespace palpate::io::internal
