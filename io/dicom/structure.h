#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate::io::internal {

/// The encoding of a dataset.
struct Encoding {
  bool big_endian = false;
  bool explicit_vr = true;
};

/// A sequential source of a dataset's bytes: of a file, or inflated.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;
  /// Fills `into` as far as bytes are left; returns their number.
  virtual std::size_t read(std::span<std::byte> into) = 0;
  /// Skips bytes; false if fewer than `count` are left.
  virtual bool skip(std::uint64_t count) = 0;
  /// Why the bytes ended early; empty if they are intact.
  virtual std::string damage() const { return {}; }
};

/// The pixel data element of a dataset.
struct PixelElement {
  static constexpr std::uint32_t undefined_length = 0xFFFFFFFF;  ///< compressed pixels, in fragments
  std::uint64_t value_at = 0;                                    ///< bytes of the dataset before its value
  std::uint32_t length = 0;                                      ///< of its value, as the file claims
  bool is_float = false;                                         ///< FloatPixelData or DoubleFloatPixelData
  bool is_double = false;                                        ///< the latter
  std::string vr;                                                ///< empty if the dataset has none
};

struct DatasetShape {
  std::uint64_t header_end = 0;  ///< bytes before the pixel data, or before the place where it would be
  std::optional<PixelElement> pixels;
  /// The places of the wanted outermost elements before the pixels. Adjoining elements form one stretch.
  struct Stretch {
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
  };
  std::vector<Stretch> wanted;
  bool has_unknown = false;  ///< whether an element is written with the VR UN
};

/// Walks over a dataset up to its pixel data without building objects. Throws DicomError if the bytes do not form
/// elements or end early, and for a dataset that would harm a parser: sequences nested deeper than in any defined
/// object (stack overflow), elements out of order (quadratic time in DCMTK), or millions of elements (memory). `wants`
/// returns whether a tag (group << 16 | element) is wanted.
DatasetShape check_structure(ByteSource& dataset, Encoding encoding, bool (*wants)(std::uint32_t tag));

}  // namespace palpate::io::internal
