#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/interchange/header_text.h"
#include "io/interchange/label_bytes.h"
#include "io/interchange/voxel_bytes.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/color.h"

namespace palpate::io {
namespace {

constexpr std::size_t most_extension = std::size_t{1} << 22;

/// The numbers of a header that are used here, of either version.
struct Header {
  std::size_t bytes = 0;  ///< of it, without the four that say whether extensions follow
  std::array<double, 8> sizes{}, spacings{};
  int number = 0, intent = 0, qform = 0, sform = 0;
  unsigned units = 0;
  double first = 0, slope = 0, offset = 0, most = 0, least = 0;
  Vec3 quaternion{0}, origin{0};
  std::array<std::array<double, 4>, 3> rows{};
};

/// Reads numbers in this machine's order.
class Numbers {
 public:
  Numbers(const std::vector<std::uint8_t>& bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  template <typename T>
  T at(std::size_t offset) const {
    std::array<std::uint8_t, sizeof(T)> raw{};
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  /// Some that follow one another.
  template <typename T, typename Into>
  void read(std::size_t offset, Into&& into, std::size_t count) const {
    for (std::size_t n = 0; n < count; ++n) {
      into[static_cast<int>(n)] = static_cast<double>(at<T>(offset + n * sizeof(T)));
    }
  }

 private:
  const std::vector<std::uint8_t>& bytes_;
  bool swapped_;
};

constexpr std::size_t bytes_of_1 = 348, bytes_of_2 = 540;

Header header_of_1(const Numbers& from) {  // nifti1.h
  Header header{.bytes = bytes_of_1};
  from.read<std::int16_t>(40, header.sizes.data(), 8);
  from.read<float>(76, header.spacings.data(), 8);
  header.intent = from.at<std::int16_t>(68);
  header.number = from.at<std::int16_t>(70);
  header.first = static_cast<double>(from.at<float>(108));
  header.slope = static_cast<double>(from.at<float>(112));
  header.offset = static_cast<double>(from.at<float>(116));
  header.units = from.at<std::uint8_t>(123);
  header.most = static_cast<double>(from.at<float>(124));
  header.least = static_cast<double>(from.at<float>(128));
  header.qform = from.at<std::int16_t>(252);
  header.sform = from.at<std::int16_t>(254);
  from.read<float>(256, header.quaternion, 3);
  from.read<float>(268, header.origin, 3);
  for (std::size_t row = 0; row < 3; ++row) from.read<float>(280 + 16 * row, header.rows[row].data(), 4);
  return header;
}

Header header_of_2(const Numbers& from) {  // nifti2.h
  Header header{.bytes = bytes_of_2};
  from.read<std::int64_t>(16, header.sizes.data(), 8);
  from.read<double>(104, header.spacings.data(), 8);
  header.intent = from.at<std::int32_t>(504);
  header.number = from.at<std::int16_t>(12);
  header.first = static_cast<double>(from.at<std::int64_t>(168));
  header.slope = from.at<double>(176);
  header.offset = from.at<double>(184);
  header.units = static_cast<unsigned>(from.at<std::int32_t>(500));
  header.most = from.at<double>(192);
  header.least = from.at<double>(200);
  header.qform = from.at<std::int32_t>(344);
  header.sform = from.at<std::int32_t>(348);
  from.read<double>(352, header.quaternion, 3);
  from.read<double>(376, header.origin, 3);
  for (std::size_t row = 0; row < 3; ++row) from.read<double>(400 + 32 * row, header.rows[row].data(), 4);
  return header;
}

/// Nothing if the bytes are the header of neither.
std::optional<std::pair<Header, bool>> header_in(const std::vector<std::uint8_t>& bytes) {
  for (const bool swapped : {false, true}) {
    const Numbers numbers(bytes, swapped);
    const auto size = static_cast<std::size_t>(numbers.at<std::int32_t>(0));
    if (size == bytes_of_1 && std::memcmp(bytes.data() + 344, "n+1", 3) == 0)
      return std::pair(header_of_1(numbers), swapped);
    if (size == bytes_of_2 && bytes.size() >= bytes_of_2 + 4 && std::memcmp(bytes.data() + 4, "n+2", 3) == 0) {
      return std::pair(header_of_2(numbers), swapped);
    }
  }
  return std::nullopt;
}

/// The first bytes of a file, unpacked, from its beginning on; fewer where it ends before.
std::vector<std::uint8_t> start_of(const VoxelFile& file, std::size_t count) {
  std::vector<std::uint8_t> bytes(count);
  try {
    voxel_bytes(file)->read(bytes);
  } catch (const DicomError&) {
    return {};
  }
  return bytes;
}

/// The bytes between header and voxels.
std::string extensions_of(VoxelFile file, std::size_t header_bytes) {
  const std::size_t end = std::min(static_cast<std::size_t>(file.first), header_bytes + most_extension);
  if (end <= header_bytes) return {};
  file.first = 0;
  const std::vector<std::uint8_t> start = start_of(file, end);
  return start.empty() ? std::string()
                       : std::string(start.begin() + static_cast<std::ptrdiff_t>(header_bytes), start.end());
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
  for (int row = 0; row < 3; ++row) {
    const auto& numbers = header.rows[static_cast<std::size_t>(row)];
    for (std::size_t axis = 0; axis < 3; ++axis) map.along[axis][row] = numbers[axis];
    map.first[row] = numbers[3];
  }
  return map;
}

VoxelMap map_by_qform(const Header& header) {
  // Longer than 1 by its rounding, or damaged: as nifti_quatern_to_mat44() of nifti1_io.c has it.
  constexpr double least = 1e-7;
  Vec3 quaternion = header.quaternion;
  const double left = 1 - glm::dot(quaternion, quaternion);
  if (left < least) quaternion = glm::normalize(quaternion);
  const double a = left < least ? 0 : std::sqrt(left), b = quaternion.x, c = quaternion.y, d = quaternion.z;
  const Vec3 size(header.spacings[1], header.spacings[2], header.spacings[3]);
  const double handed = header.spacings[0] < 0 ? -1 : 1;
  VoxelMap map;
  map.along[0] = size.x * Vec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
  map.along[1] = size.y * Vec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b));
  map.along[2] = handed * size.z * Vec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c);
  map.first = header.origin;
  return map;
}

/// Voxels to LPS, mm.
VoxelMap map_of(const Header& header) {
  const bool has_sform = header.sform > 0, has_qform = header.qform > 0;
  if (!has_sform && !has_qform) throw DicomError(say("nifti-without-a-place"));
  VoxelMap map = has_sform ? map_by_sform(header) : map_by_qform(header);
  constexpr unsigned meters = 1, micrometers = 3;
  const unsigned unit = header.units & 7U;
  const double mm = unit == meters ? 1e3 : unit == micrometers ? 1e-3 : 1;
  const Vec3 to_lps = mm * Vec3(-1, -1, 1);
  for (Vec3& along : map.along) along *= to_lps;
  map.first *= to_lps;
  return map;
}

/// Where voxels of several volumes lie one behind the other: time, or whatever else the further axes count.
int volumes_of(const Header& header) {
  double volumes = 1;
  for (std::size_t axis = 4; axis < header.sizes.size() && static_cast<double>(axis) <= header.sizes[0]; ++axis) {
    volumes *= std::max(1.0, header.sizes[axis]);
  }
  return count_of_volumes(volumes);
}

std::optional<Series::Window> window_of(const Header& header) {
  const double most = header.most, least = header.least;
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
      rgb.push_back(most * number_in(attribute(element, color)));
    }
    names[std::atoi(attribute(element, "Key").c_str())] = {name, color_of_rgb(rgb)};  // NOLINT: 0 is no label
  }
  return names;
}

std::optional<VoxelFile> open_nifti(const std::filesystem::path& path, const std::filesystem::path& named) {
  if (!has_ending(named, ".nii") && !has_ending(named, ".nii.gz")) return std::nullopt;
  VoxelFile file;
  file.path = file.voxels_at = path;
  file.packing = is_gzipped(path) ? VoxelFile::Packing::whole : VoxelFile::Packing::none;
  std::vector<std::uint8_t> start = start_of(file, bytes_of_2 + 4);
  if (start.empty()) start = start_of(file, bytes_of_1 + 4);
  if (start.empty()) return std::nullopt;
  const auto found = header_in(start);
  if (!found) throw DicomError(say("nifti-of-another-kind"));
  const auto& [header, swapped] = *found;
  file.swapped = swapped;
  file.volumes = volumes_of(header);
  constexpr int rgb = 128, rgba = 2304;
  if (header.number == rgb || header.number == rgba) {
    read_as_colors(header.number == rgb ? 3 : 4, file);
  } else {
    file.number = number_of(header.number);
  }
  if (std::isfinite(header.slope) && header.slope != 0) {
    file.slope = header.slope;
    file.offset = std::isfinite(header.offset) ? header.offset : 0;
  }
  file.window = window_of(header);
  const std::size_t least = header.bytes + 4;
  file.first = std::isfinite(header.first)
                   ? static_cast<std::int64_t>(std::clamp(header.first, static_cast<double>(least), 1e9))
                   : static_cast<std::int64_t>(least);
  constexpr int labels = 1002;
  file.names = names_in(extensions_of(file, least));
  file.said_to_be_labels = header.intent == labels || !file.names.empty();
  const auto size = [&header = header](std::size_t axis) {
    const double one = header.sizes[axis];
    return one >= 1 && one <= 1e6 ? static_cast<int>(one) : 0;
  };
  place(map_of(header), {size(1), size(2), size(3)}, file);
  return file;
}

}  // namespace

extern const LabelFormat nifti_format;
const LabelFormat nifti_format{.name = "NIfTI",
                               .endings = {".nii", ".nii.gz"},
                               .open = open_nifti,
                               .written = {".nii.gz", ".nii"},
                               .bytes = nifti_bytes};

}  // namespace palpate::io
