#include "io/structures/label_image.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr double most_voxels = 2147483648.0, most_of_a_slice = 16777216.0;

std::size_t bytes_of(LabelImage::Number number) {
  switch (number) {
    case LabelImage::Number::u8:
    case LabelImage::Number::i8:
      return 1;
    case LabelImage::Number::u16:
    case LabelImage::Number::i16:
      return 2;
    case LabelImage::Number::u32:
    case LabelImage::Number::i32:
    case LabelImage::Number::f32:
      return 4;
    case LabelImage::Number::f64:
      break;
  }
  return 8;
}

template <typename T>
double value_in(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

double value_at(LabelImage::Number number, const std::uint8_t* from) {
  switch (number) {
    case LabelImage::Number::u8:
      return value_in<std::uint8_t>(from);
    case LabelImage::Number::i8:
      return value_in<std::int8_t>(from);
    case LabelImage::Number::u16:
      return value_in<std::uint16_t>(from);
    case LabelImage::Number::i16:
      return value_in<std::int16_t>(from);
    case LabelImage::Number::u32:
      return value_in<std::uint32_t>(from);
    case LabelImage::Number::i32:
      return value_in<std::int32_t>(from);
    case LabelImage::Number::f32:
      return value_in<float>(from);
    case LabelImage::Number::f64:
      break;
  }
  return value_in<double>(from);
}

struct CloseGz {
  void operator()(gzFile_s* file) const noexcept { gzclose(file); }
};
using GzFile = std::unique_ptr<gzFile_s, CloseGz>;

[[noreturn]] void refuse_end() {
  throw DicomError(say("labels-end-early"));
}

/// At the first voxel. zlib passes through what is not compressed.
GzFile open_at_voxels(const LabelImage& image) {
  const int descriptor = ::open(image.path.c_str(), O_RDONLY | O_CLOEXEC);  // NOLINT: POSIX
  if (descriptor < 0) refuse_end();
  if (image.packed_after) ::lseek(descriptor, image.first, SEEK_SET);
  GzFile file(gzdopen(descriptor, "rb"));
  if (!file) {
    ::close(descriptor);
    refuse_end();
  }
  if (!image.packed_after && gzseek(file.get(), image.first, SEEK_SET) != image.first) refuse_end();
  return file;
}

void read_all(gzFile_s& file, std::span<std::uint8_t> into) {
  constexpr std::size_t most = std::size_t{1} << 28;
  for (std::size_t done = 0; done < into.size();) {
    const auto part = static_cast<unsigned>(std::min(most, into.size() - done));
    const int count = gzread(&file, into.data() + done, part);
    if (count <= 0) refuse_end();
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace

void read_slices(const LabelImage& image, const std::function<bool(int, std::span<const double>)>& slice) {
  const GzFile file = open_at_voxels(image);
  const glm::ivec3 size = image.geometry.dimensions;
  const std::size_t count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  const std::size_t bytes = bytes_of(image.number);
  std::vector<std::uint8_t> raw(count * bytes);
  std::vector<double> values(count);
  for (int k = 0; k < size.z; ++k) {
    read_all(*file, raw);
    for (std::size_t n = 0; n < count; ++n) {
      std::uint8_t* const at = raw.data() + n * bytes;
      if (image.swapped) std::reverse(at, at + bytes);
      values[n] = value_at(image.number, at) * image.slope + image.offset;
    }
    if (!slice(image.reversed ? size.z - 1 - k : k, values)) return;
  }
}

void place(const Vec3& along_i, const Vec3& along_j, const Vec3& along_k, const Vec3& first, const glm::ivec3& size,
           LabelImage& image) {
  constexpr double square = 1e-3;
  const double i = glm::length(along_i), j = glm::length(along_j), k = glm::length(along_k);
  const bool sized = size.x > 0 && size.y > 0 && size.z > 0 &&
                     static_cast<double>(size.x) * size.y <= most_of_a_slice &&
                     static_cast<double>(size.x) * size.y * size.z <= most_voxels;
  const bool finite = std::isfinite(i + j + k + glm::length(first)) && i > 0 && j > 0 && k > 0;
  if (!sized || !finite || std::abs(glm::dot(along_i, along_j)) > square * i * j) {
    throw DicomError(say("labels-on-no-lattice"));
  }
  Geometry& geometry = image.geometry;
  geometry.dimensions = size;
  geometry.direction_i = along_i / i;
  geometry.direction_j = along_j / j;
  geometry.spacing_i = i;
  geometry.spacing_j = j;
  image.reversed = glm::dot(glm::cross(along_i, along_j), along_k) < 0;
  geometry.step = image.reversed ? -along_k : along_k;
  const Vec3 lowest = image.reversed ? first + (size.z - 1.0) * along_k : first;
  geometry.slice_positions.clear();
  for (int n = 0; n < size.z; ++n) geometry.slice_positions.push_back(lowest + static_cast<double>(n) * geometry.step);
  geometry.uniform = true;
}

}  // namespace palpate::io
