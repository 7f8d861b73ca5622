#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <glm/geometric.hpp>
#include <vector>

#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/color.h"
#include "io/structures/label_image.h"

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

bool ends_with(std::string name, const std::string& end) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name.size() >= end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0;
}

std::vector<std::uint8_t> start_of(const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes(header_bytes + 4 + most_extension);
  gzFile_s* const file = gzopen(path.c_str(), "rb");
  if (file == nullptr) return {};
  const int count = gzread(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  bytes.resize(static_cast<std::size_t>(std::max(0, count)));
  return bytes;
}

LabelImage::Number number_of(int type) {
  switch (type) {
    case 2:
      return LabelImage::Number::u8;
    case 4:
      return LabelImage::Number::i16;
    case 8:
      return LabelImage::Number::i32;
    case 16:
      return LabelImage::Number::f32;
    case 64:
      return LabelImage::Number::f64;
    case 256:
      return LabelImage::Number::i8;
    case 512:
      return LabelImage::Number::u16;
    case 768:
      return LabelImage::Number::u32;
    default:
      throw DicomError(say("labels-of-another-type"));
  }
}

/// Voxels to RAS, mm: columns, and where the first voxel is. The sform goes before the qform, as the standard has it.
struct Affine {
  Vec3 i{1, 0, 0}, j{0, 1, 0}, k{0, 0, 1}, first{0};
};

Affine affine_of(const Header& header) {
  const Vec3 size(header.number(80), header.number(84), header.number(88));
  Affine map;
  if (header.at<std::int16_t>(254) > 0) {
    std::size_t at = 280;
    for (int row = 0; row < 3; ++row, at += 16) {
      map.i[row] = header.number(at);
      map.j[row] = header.number(at + 4);
      map.k[row] = header.number(at + 8);
      map.first[row] = header.number(at + 12);
    }
  } else if (header.at<std::int16_t>(252) > 0) {
    const double b = header.number(256), c = header.number(260), d = header.number(264);
    const double a = std::sqrt(std::max(0.0, 1 - b * b - c * c - d * d));
    const double handed = header.number(76) < 0 ? -1 : 1;
    map.i = size.x * Vec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
    map.j = size.y * Vec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b));
    map.k = handed * size.z * Vec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c);
    map.first = {header.number(268), header.number(272), header.number(276)};
  } else {
    throw DicomError(say("nifti-without-a-place"));
  }
  constexpr std::uint8_t meters = 1, micrometers = 3;
  const std::uint8_t unit = header.at<std::uint8_t>(123) & 7U;
  const double mm = unit == meters ? 1e3 : unit == micrometers ? 1e-3 : 1;
  map.i *= mm;
  map.j *= mm;
  map.k *= mm;
  map.first *= mm;
  return map;
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

std::optional<LabelImage> open_nifti(const std::filesystem::path& path) {
  const std::string file = path.filename().string();
  if (!ends_with(file, ".nii") && !ends_with(file, ".nii.gz")) return std::nullopt;
  const std::vector<std::uint8_t> start = start_of(path);
  if (start.size() < header_bytes + 4) return std::nullopt;
  const bool swapped = Header(start, true).at<std::int32_t>(0) == header_bytes;
  const Header header(start, swapped);
  if (header.at<std::int32_t>(0) != header_bytes || std::memcmp(start.data() + 344, "n+1", 3) != 0) {
    throw DicomError(say("labels-of-another-nifti"));
  }
  LabelImage image;
  image.path = path;
  image.swapped = swapped;
  const int axes = header.at<std::int16_t>(40);
  glm::ivec3 size(header.at<std::int16_t>(42), header.at<std::int16_t>(44), header.at<std::int16_t>(46));
  std::size_t at = 48;
  for (int axis = 4; axis <= std::min(axes, 7); ++axis, at += 2) {
    if (header.at<std::int16_t>(at) > 1) {
      throw DicomError(say("labels-in-several-volumes"));
    }
  }
  image.number = number_of(header.at<std::int16_t>(70));
  if (const double slope = header.number(112); std::isfinite(slope) && slope != 0) {
    image.slope = slope;
    image.offset = header.number(116);
  }
  const double first = header.number(108);
  image.first = std::isfinite(first) ? static_cast<std::int64_t>(std::clamp(first, 352.0, 1e9)) : 352;
  constexpr int labels = 1002;
  const auto end = std::min(start.size(), static_cast<std::size_t>(image.first));
  image.names =
      names_in(std::string(start.begin() + header_bytes + 4, start.begin() + static_cast<std::ptrdiff_t>(end)));
  image.said_to_be_labels = header.at<std::int16_t>(68) == labels || !image.names.empty();
  const Affine map = affine_of(header);
  const Vec3 to_lps(-1, -1, 1);
  place(to_lps * map.i, to_lps * map.j, to_lps * map.k, to_lps * map.first, size, image);
  return image;
}

}  // namespace palpate::io
