#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <vector>

#include "io/errors.h"
#include "io/interchange/header_text.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/color.h"

namespace palpate::io {
namespace {

constexpr double most_layers = 255;

/// Fields ("sizes: 512 512 3") and key-value pairs ("Segment0_Name:=liver") by their names.
using Fields = HeaderFields;

Fields fields_in(std::istream& file) {
  constexpr int most_lines = 100000;
  Fields fields;
  std::string line;
  for (int n = 0; n < most_lines && std::getline(file, line); ++n) {
    if (trimmed(line).empty()) return fields;
    const std::size_t colon = line.find(':');
    if (line.front() == '#' || colon == std::string::npos) continue;
    const bool pair = colon + 1 < line.size() && line[colon + 1] == '=';
    fields[trimmed(line.substr(0, colon))] = trimmed(line.substr(colon + (pair ? 2 : 1)));
  }
  return fields;  // a header alone ends where its file does
}

VoxelFile::Number number_of(const std::string& type) {
  using Number = VoxelFile::Number;
  static const std::map<std::string, Number> types{
      {"uchar", Number::u8},         {"unsigned char", Number::u8},   {"uint8", Number::u8},
      {"uint8_t", Number::u8},       {"signed char", Number::i8},     {"int8", Number::i8},
      {"int8_t", Number::i8},        {"short", Number::i16},          {"short int", Number::i16},
      {"signed short", Number::i16}, {"int16", Number::i16},          {"int16_t", Number::i16},
      {"ushort", Number::u16},       {"unsigned short", Number::u16}, {"unsigned short int", Number::u16},
      {"uint16", Number::u16},       {"uint16_t", Number::u16},       {"int", Number::i32},
      {"signed int", Number::i32},   {"int32", Number::i32},          {"int32_t", Number::i32},
      {"uint", Number::u32},         {"unsigned int", Number::u32},   {"uint32", Number::u32},
      {"uint32_t", Number::u32},     {"longlong", Number::i64},       {"long long", Number::i64},
      {"int64", Number::i64},        {"int64_t", Number::i64},        {"ulonglong", Number::u64},
      {"uint64", Number::u64},       {"uint64_t", Number::u64},       {"float", Number::f32},
      {"double", Number::f64}};
  const auto found = types.find(type);
  if (found == types.end()) {
    throw DicomError(say("voxels-of-another-type"));
  }
  return found->second;
}

/// From the file's space to LPS.
Vec3 to_lps(const std::string& space) {
  if (space == "left-posterior-superior" || space == "LPS") return {1, 1, 1};
  if (space == "right-anterior-superior" || space == "RAS") return {-1, -1, 1};
  if (space == "left-anterior-superior" || space == "LAS") return {1, -1, 1};
  throw DicomError(say("nrrd-without-a-place"));
}

/// Slicer's: Segment0_Name, Segment0_LabelValue, Segment0_Layer, Segment0_Color.
std::map<int, LabelName> names_in(const Fields& fields) {
  constexpr double most = 255;
  std::map<int, LabelName> names;
  for (int n = 0;; ++n) {
    const std::string segment = "Segment" + std::to_string(n) + "_";
    const auto name = fields.find(segment + "Name");
    if (name == fields.end()) return names;
    const std::vector<double> label = numbers(field(fields, {segment + "LabelValue"}));
    std::vector<double> rgb = numbers(field(fields, {segment + "Color"}));
    for (double& part : rgb) part *= most;
    const bool given = !label.empty() && std::isfinite(label.front());
    const int value = !given ? n + 1 : static_cast<int>(std::clamp(label.front(), 0.0, 65535.0));
    const std::vector<double> layer = numbers(field(fields, {segment + "Layer"}));
    const bool has_layer = !layer.empty() && std::isfinite(layer.front());
    const int in_layer = has_layer ? static_cast<int>(std::clamp(layer.front(), 0.0, most_layers)) : 0;
    names[label_number(in_layer, value)] = {name->second, color_of_rgb(rgb)};
  }
}

// How many numbers a voxel has: where the first axis is no direction in space and segments have their layers in it.
// Elsewhere a number alone is read.
int layers_of(const Fields& fields) {
  const std::vector<double> sizes = numbers(field(fields, {"sizes"}));
  const bool are_layers = sizes.size() == 4 && field(fields, {"space directions"}).starts_with("none") &&
                          fields.contains("Segment0_Layer") && sizes[0] >= 1 && sizes[0] <= most_layers;
  return are_layers ? static_cast<int>(sizes[0]) : 1;
}

// Sizes along its axes; refused where they are not those of one volume with one value a voxel, or with layers.
glm::ivec3 size_of(const Fields& fields) {
  std::vector<double> sizes = numbers(field(fields, {"sizes"}));
  if (sizes.size() == 4 && layers_of(fields) > 1) sizes.erase(sizes.begin());
  if (sizes.size() == 4) {  // which of the four is no direction in space?
    std::istringstream directions(field(fields, {"space directions"}));
    std::string word;
    for (std::size_t axis = 0; axis < 4 && directions >> word; ++axis) {
      if (word != "none" || !(std::abs(sizes[axis]) < 1e9)) continue;
      throw DicomError(say("voxels-have-several-values", static_cast<int>(sizes[axis])));
    }
  }
  if (sizes.size() != 3) throw DicomError(say("labels-in-several-volumes"));
  const auto size = [&](std::size_t n) {
    return std::isfinite(sizes[n]) ? static_cast<int>(std::clamp(sizes[n], 0.0, 65535.0)) : 0;
  };
  return {size(0), size(1), size(2)};
}

VoxelMap map_of(const Fields& fields) {
  std::vector<double> directions = numbers(field(fields, {"space directions"}));
  if (layers_of(fields) > 1) directions.erase(directions.begin());  // "none"
  const std::vector<double> origin = numbers(field(fields, {"space origin"}));
  if (directions.size() != 9 || origin.size() != 3) to_lps({});
  const Vec3 sign = to_lps(field(fields, {"space"}));
  VoxelMap map;
  for (std::size_t n = 0; n < 3; ++n) {
    map.along[n] = sign * Vec3(directions[3 * n], directions[3 * n + 1], directions[3 * n + 2]);
  }
  map.first = sign * Vec3(origin[0], origin[1], origin[2]);
  return map;
}

// Where the voxels are: behind the header, which ends at `header_end`, or in a file beside it.
void find_voxels(const Fields& fields, std::int64_t header_end, VoxelFile& file) {
  const std::string data = field(fields, {"data file", "datafile"});
  file.voxels_at = data.empty() ? file.path : beside(file.path, data);
  file.first = data.empty() ? header_end : 0;
  const std::string encoding = field(fields, {"encoding"});
  const bool packed = encoding == "gzip" || encoding == "gz";
  if (!packed && encoding != "raw") throw DicomError(say("voxels-in-another-encoding", encoding));
  if (packed) file.packing = VoxelFile::Packing::behind_it;
  const auto skipped = [&](const std::string& first, const std::string& second) {
    const std::vector<double> count = numbers(field(fields, {first}) + " " + field(fields, {second}));
    return count.empty() || !std::isfinite(count.front()) ? 0.0 : count.front();
  };
  const double bytes = skipped("byte skip", "byteskip");
  if (skipped("line skip", "lineskip") != 0 || (packed && bytes != 0) || bytes < -1 || bytes > 1e9) {
    throw DicomError(say("voxels-in-another-encoding", "raw with lines or packed bytes to be skipped"));
  }
  constexpr double from_the_end = -1;
  if (bytes == from_the_end) {
    const auto needed = static_cast<std::int64_t>(file.numbers_of_slice() * static_cast<std::size_t>(file.size.z) *
                                                  bytes_of(file.number));
    std::error_code ignored;
    file.first = std::max<std::int64_t>(
        0, static_cast<std::int64_t>(std::filesystem::file_size(file.voxels_at, ignored)) - needed);
  } else {
    file.first += static_cast<std::int64_t>(bytes);
  }
}

}  // namespace

std::optional<VoxelFile> open_nrrd(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string magic(4, '\0');
  if (!stream.read(magic.data(), 4) || magic != "NRRD") return std::nullopt;
  std::string line;
  std::getline(stream, line);
  const Fields fields = fields_in(stream);
  stream.clear();  // a header alone may end without an empty line
  VoxelFile file;
  file.path = path;
  const auto header_end = static_cast<std::int64_t>(stream.tellg());
  file.number = number_of(field(fields, {"type"}));
  file.swapped = field(fields, {"endian"}) == (std::endian::native == std::endian::little ? "big" : "little");
  file.names = names_in(fields);
  file.said_to_be_labels = !file.names.empty();
  file.layers = layers_of(fields);
  const glm::ivec3 size = size_of(fields);
  place(map_of(fields), size, file);
  find_voxels(fields, header_end, file);
  return file;
}

}  // namespace palpate::io
