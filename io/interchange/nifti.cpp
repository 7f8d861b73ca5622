#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/vec3.hpp>
#include <vector>

#include "io/errors.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/color.h"

namespace palpate::io {
namespace {

constexpr int header_bytes = 348;
constexpr std::size_t most_extension = std::size_t{1} << 22;

/// The header, with its numbers in this machine's order.
class Header {
 public:
  Header(const std::vector<std::uint8_t>& bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  template <typename T>
  T at(std::size_t offset) const {
    std::array<std::uint8_t, sizeof(T)> raw{};
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  double number(std::size_t offset) const { return static_cast<double>(at<float>(offset)); }

 private:
  const std::vector<std::uint8_t>& bytes_;
  bool swapped_;
};

std::vector<std::uint8_t> start_of(const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes(header_bytes + 4 + most_extension);
  gzFile_s* const file = gzopen(path.c_str(), "rb");
  if (file == nullptr) return {};
  const int count = gzread(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  bytes.resize(static_cast<std::size_t>(std::max(0, count)));
  return bytes;
}

bool is_gzipped(const std::filesystem::path& path) {
  std::array<char, 2> magic{};
  std::ifstream(path, std::ios::binary).read(magic.data(), magic.size());
  return magic == std::array{'\x1f', '\x8b'};
}

VoxelFile::Number number_of(int type) {
  switch (type) {
    case 2:
      return VoxelFile::Number::u8;
    case 4:
      return VoxelFile::Number::i16;
    case 8:
      return VoxelFile::Number::i32;
    case 16:
      return VoxelFile::Number::f32;
    case 64:
      return VoxelFile::Number::f64;
    case 256:
      return VoxelFile::Number::i8;
    case 512:
      return VoxelFile::Number::u16;
    case 768:
      return VoxelFile::Number::u32;
    case 1024:
      return VoxelFile::Number::i64;
    case 1280:
      return VoxelFile::Number::u64;
    default:
      throw DicomError(say("voxels-of-another-type"));
  }
}

/// Voxels to RAS, in the file's unit: sform, or qform. The sform goes before the qform, as the standard has it.
VoxelMap map_by_sform(const Header& header) {
  VoxelMap map;
  std::size_t at = 280;
  for (int row = 0; row < 3; ++row, at += 16) {
    for (std::size_t axis = 0; axis < 3; ++axis) map.along[axis][row] = header.number(at + 4 * axis);
    map.first[row] = header.number(at + 12);
  }
  return map;
}

VoxelMap map_by_qform(const Header& header) {
  const Vec3 size(header.number(80), header.number(84), header.number(88));
  const double b = header.number(256), c = header.number(260), d = header.number(264);
  const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
  const double handed = header.number(76) < 0 ? -1 : 1;
  VoxelMap map;
  map.along[0] = size.x * Vec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
  map.along[1] = size.y * Vec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b));
  map.along[2] = handed * size.z * Vec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c);
  map.first = {header.number(268), header.number(272), header.number(276)};
  return map;
}

/// Voxels to LPS, mm.
VoxelMap map_of(const Header& header) {
  const bool has_sform = header.at<std::int16_t>(254) > 0, has_qform = header.at<std::int16_t>(252) > 0;
  if (!has_sform && !has_qform) throw DicomError(say("nifti-without-a-place"));
  VoxelMap map = has_sform ? map_by_sform(header) : map_by_qform(header);
  constexpr std::uint8_t meters = 1, micrometers = 3;
  const std::uint8_t unit = header.at<std::uint8_t>(123) & 7U;
  const double mm = unit == meters ? 1e3 : unit == micrometers ? 1e-3 : 1;
  const Vec3 to_lps = mm * Vec3(-1, -1, 1);
  for (Vec3& along : map.along) along *= to_lps;
  map.first *= to_lps;
  return map;
}

/// Where voxels of several volumes lie one behind the other: time, or whatever else the further axes count.
int volumes_of(const Header& header) {
  const int axes = header.at<std::int16_t>(40);
  std::int64_t volumes = 1;
  for (int axis = 4; axis <= std::min(axes, 7); ++axis) {
    volumes *= std::max<int>(1, header.at<std::int16_t>(40 + 2 * static_cast<std::size_t>(axis)));
    if (volumes > 1'000'000) throw DicomError(say("voxels-on-no-lattice"));
  }
  return static_cast<int>(volumes);
}

std::optional<Series::Window> window_of(const Header& header) {
  const double most = header.number(124), least = header.number(128);
  if (!std::isfinite(most) || !std::isfinite(least) || !(most > least)) return std::nullopt;
  return Series::Window{(most + least) / 2, most - least};
}

std::string attribute(const std::string& element, const std::string& name) {
  const std::size_t at = element.find(name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t from = at + name.size() + 2;
  constexpr char quote = '\x22';
  return element.substr(from, element.find(quote, from) - from);
}

/// Of the table that Connectome Workbench and TotalSegmentator write into an extension.
std::map<int, LabelName> names_in(const std::string& text) {
  constexpr double most = 255;
  std::map<int, LabelName> names;
  for (std::size_t at = text.find("<Label "); at != std::string::npos; at = text.find("<Label ", at + 1)) {
    const std::size_t close = text.find('>', at);
    const std::size_t end = text.find("</Label>", at);
    if (close == std::string::npos || end == std::string::npos || end < close) break;
    const std::string element = text.substr(at, close - at);
    std::string name = text.substr(close + 1, end - close - 1);
    const std::string open = "<![CDATA[", shut = "]]>";
    if (name.starts_with(open) && name.ends_with(shut)) {
      name = name.substr(open.size(), name.size() - open.size() - shut.size());
    }
    std::vector<double> rgb;
    for (const char* color : {"Red", "Green", "Blue"}) {
      rgb.push_back(most * std::strtod(attribute(element, color).c_str(), nullptr));
    }
    names[std::atoi(attribute(element, "Key").c_str())] = {name, color_of_rgb(rgb)};  // NOLINT: 0 is no label
  }
  return names;
}

}  // namespace

std::optional<VoxelFile> open_nifti(const std::filesystem::path& path, const std::filesystem::path& named) {
  if (!has_ending(named, ".nii") && !has_ending(named, ".nii.gz")) return std::nullopt;
  const std::vector<std::uint8_t> start = start_of(path);
  if (start.size() < header_bytes + 4) return std::nullopt;
  const bool swapped = Header(start, true).at<std::int32_t>(0) == header_bytes;
  const Header header(start, swapped);
  if (header.at<std::int32_t>(0) != header_bytes || std::memcmp(start.data() + 344, "n+1", 3) != 0) {
    throw DicomError(say("nifti-of-another-kind"));
  }
  VoxelFile file;
  file.path = file.voxels_at = path;
  file.packing = is_gzipped(path) ? VoxelFile::Packing::whole : VoxelFile::Packing::none;
  file.swapped = swapped;
  file.volumes = volumes_of(header);
  file.number = number_of(header.at<std::int16_t>(70));
  if (const double slope = header.number(112); std::isfinite(slope) && slope != 0) {
    const double offset = header.number(116);
    file.slope = slope;
    file.offset = std::isfinite(offset) ? offset : 0;
  }
  file.window = window_of(header);
  const double first = header.number(108);
  file.first = std::isfinite(first) ? static_cast<std::int64_t>(std::clamp(first, 352.0, 1e9)) : 352;
  constexpr int labels = 1002;
  const auto end = std::min(start.size(), static_cast<std::size_t>(file.first));
  file.names =
      names_in(std::string(start.begin() + header_bytes + 4, start.begin() + static_cast<std::ptrdiff_t>(end)));
  file.said_to_be_labels = header.at<std::int16_t>(68) == labels || !file.names.empty();
  place(map_of(header), {header.at<std::int16_t>(42), header.at<std::int16_t>(44), header.at<std::int16_t>(46)}, file);
  return file;
}

}  // namespace palpate::io
