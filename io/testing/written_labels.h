#pragma once

/// Label maps to be written, and what is needed to read their bytes.

#include <zlib.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/structures/label_image.h"

namespace palpate::io::internal {

/// On a lattice of steps along i, j and k; a voxel in three is inside.
inline LabelImage image_on(const Vec3& i, const Vec3& j, const Vec3& k, const Vec3& first, const glm::ivec3& size) {
  LabelImage image;
  image.label.name = "left kidney";
  image.label.color = "#3366ff";
  Geometry& g = image.geometry;
  g.dimensions = size;
  g.spacing_i = glm::length(i);
  g.spacing_j = glm::length(j);
  g.direction_i = i / g.spacing_i;
  g.direction_j = j / g.spacing_j;
  g.step = k;
  for (int n = 0; n < size.z; ++n) g.slice_positions.push_back(first + static_cast<double>(n) * k);
  for (int n = 0; n < size.x * size.y * size.z; ++n) image.inside.push_back(n % 3 == 0 ? 1 : 0);
  return image;
}

/// Images along the patient's axes, feet first, rotated about an oblique axis, and with a tilted gantry.
inline std::vector<LabelImage> images() {
  const Vec3 i(6.0 / 7, 2.0 / 7, -3.0 / 7), j(3.0 / 7, -6.0 / 7, 2.0 / 7), k = glm::cross(i, j);
  return {image_on({0.5, 0, 0}, {0, 2, 0}, {0, 0, 3}, {-4, 5, 6}, {4, 3, 5}),
          image_on({-0.5, 0, 0}, {0, 2, 0}, {0, 0, -3}, {40, -5, 6}, {3, 4, 2}),
          image_on(0.75 * i, 1.5 * j, 2.5 * k, {10, -20, 30}, {5, 4, 3}),
          image_on({0.5, 0, 0}, {0, 2, 0}, {0, 1, 3}, {-4, 5, 6}, {4, 3, 5}),
          image_on({0.5, 0, 0}, {0, 2, 0}, {-0.5, 0, 3}, {-4, 5, 6}, {4, 3, 5})};
}

inline bool is_straight(const LabelImage& image) {
  const Geometry& g = image.geometry;
  return glm::length(glm::cross(g.step, glm::cross(g.direction_i, g.direction_j))) < 1e-9;
}

inline std::string voxels_in(const LabelImage& image) {
  return {image.inside.begin(), image.inside.end()};
}

/// One stream of gzip or of zlib, as `window_bits` asks for; throws if it is not one, or if anything follows it.
inline std::string inflated(std::string bytes, int window_bits) {
  z_stream stream{};
  if (inflateInit2(&stream, window_bits) != Z_OK) throw std::runtime_error("zlib");
  std::string out(1U << 16, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = inflate(&stream, Z_FINISH);
  out.resize(out.size() - stream.avail_out);
  const bool is_whole = status == Z_STREAM_END && stream.avail_in == 0;
  inflateEnd(&stream);
  if (!is_whole) throw std::runtime_error("not one stream");
  return out;
}
constexpr int gzip_bits = MAX_WBITS + 16, zlib_bits = MAX_WBITS;

template <typename T>
T number_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace palpate::io::internal
