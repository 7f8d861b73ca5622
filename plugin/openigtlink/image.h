#pragma once

/// IMAGE: a label map sent by a client. Source: OpenIGTLink protocol, "IMAGE"; the position on the wire is that of the
/// image's center, as 3D Slicer sends it.

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>

#include "plugin/openigtlink/bytes.h"

namespace palpate::plugin::igtl {

inline constexpr std::size_t image_header_size = 72;
/// Size of the largest accepted image, bytes: 1024 x 1024 x 512 labels of 8 bits.
inline constexpr std::size_t largest_image = image_header_size + (std::size_t{1} << 29U);

struct Image {
  enum class Number : std::uint8_t { i8 = 2, u8 = 3, i16 = 4, u16 = 5, i32 = 6, u32 = 7 };
  Number number = Number::u8;
  bool big_endian = false;
  glm::ivec3 size{0};
  std::array<glm::dvec3, 3> along{};  ///< from one voxel to the next, LPS, mm
  glm::dvec3 first{0};                ///< center of the first voxel, LPS, mm
  ByteView voxels;                    ///< within the content that was read
};

/// Throws InvalidInput unless it is a complete image of integers, one a voxel, whose size matches its bytes.
Image image_of(ByteView content);
/// In the form of the wire: RAS, with the position of the center.
Bytes content_of(const Image& image);

/// Writes a NRRD, which io/structures reads. Throws Refusal that names the file if it cannot be written.
void write_nrrd(const Image& image, const std::filesystem::path& file);

}  // namespace palpate::plugin::igtl
