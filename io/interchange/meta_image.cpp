// MetaImage as in ITK: its world is LPS, mm, and its TransformMatrix has a row for each axis of the file.

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <vector>

#include "io/errors.h"
#include "io/interchange/header_text.h"
#include "io/interchange/label_bytes.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

using Fields = HeaderFields;

// "Key = value", up to ElementDataFile, behind which the voxels may begin.
Fields fields_in(std::istream& file) {
  Fields fields;
  std::string line;
  for (HeaderLines lines(file); lines.next(line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) continue;
    const std::string key = trimmed(line.substr(0, equals));
    fields[key] = trimmed(line.substr(equals + 1));
    if (key == "ElementDataFile") break;
  }
  return fields;
}

bool is_true(const std::string& text) {
  return !text.empty() && (text.front() == 'T' || text.front() == 't' || text.front() == '1');
}

VoxelFile::Number number_of(const std::string& type) {
  using Number = VoxelFile::Number;
  static const std::map<std::string, Number> types{
      {"MET_UCHAR", Number::u8},      {"MET_CHAR", Number::i8},        {"MET_ASCII_CHAR", Number::i8},
      {"MET_USHORT", Number::u16},    {"MET_SHORT", Number::i16},      {"MET_UINT", Number::u32},
      {"MET_INT", Number::i32},       {"MET_ULONG", Number::u32},      {"MET_LONG", Number::i32},
      {"MET_LONG_LONG", Number::i64}, {"MET_ULONG_LONG", Number::u64}, {"MET_FLOAT", Number::f32},
      {"MET_DOUBLE", Number::f64}};
  const auto found = types.find(type);
  if (found == types.end()) throw DicomError(say("voxels-of-another-type"));
  return found->second;
}

// Three numbers of a field, or their default if it is missing.
Vec3 three(const Fields& fields, const std::initializer_list<std::string>& names, const Vec3& otherwise) {
  const std::string text = field(fields, names);
  if (text.empty()) return otherwise;
  const std::vector<double> all = numbers(text);
  if (all.size() < 3) throw DicomError(say("meta-image-of-another-kind"));
  return {all[0], all[1], all[2]};
}

VoxelMap map_of(const Fields& fields, std::size_t axes) {
  VoxelMap map;
  const Vec3 spacing = three(fields, {"ElementSpacing", "ElementSize"}, Vec3(1));
  const std::vector<double> rows = numbers(field(fields, {"TransformMatrix", "Rotation", "Orientation"}));
  if (!rows.empty() && rows.size() != axes * axes) throw DicomError(say("meta-image-of-another-kind"));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!rows.empty()) map.along[axis] = {rows[axes * axis], rows[axes * axis + 1], rows[axes * axis + 2]};
    map.along[axis] *= spacing[static_cast<int>(axis)];
  }
  map.first = three(fields, {"Offset", "Position", "Origin"}, Vec3(0));
  return map;
}

// For missing fields ITK assumes 1 mm, no rotation and the origin. So do we, with a remark.
void remark_on_what_is_not_said(const Fields& fields, VoxelFile& file) {
  std::string missing;
  const auto look = [&](const std::initializer_list<std::string>& names) {
    if (field(fields, names).empty()) missing += (missing.empty() ? "" : ", ") + *names.begin();
  };
  look({"ElementSpacing", "ElementSize"});
  look({"Offset", "Position", "Origin"});
  look({"TransformMatrix", "Rotation", "Orientation"});
  if (!missing.empty()) file.remarks.push_back(say("meta-image-does-not-say", missing));
}

void find_voxels(const Fields& fields, std::int64_t header_end, VoxelFile& file) {
  const std::string data = field(fields, {"ElementDataFile"});
  const bool is_local = data == "LOCAL" || data == "Local" || data == "local";
  file.voxels_at = is_local ? file.path : beside(file.path, data);
  file.first = is_local ? header_end : 0;
  if (is_true(field(fields, {"CompressedData"}))) file.packing = VoxelFile::Packing::behind_it;
  // As ITK has it: from the beginning of the file that holds the voxels, whichever that is; 0 says nothing.
  const std::vector<double> skipped = numbers(field(fields, {"HeaderSize"}));
  if (skipped.empty() || skipped.front() == 0 || !(std::abs(skipped.front()) < 1e9)) return;
  if (skipped.front() > 0) {
    file.first = static_cast<std::int64_t>(skipped.front());
  } else {  // the voxels are what the file ends with
    std::error_code ignored;
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file.voxels_at, ignored));
    const std::size_t needed = file.numbers_of_slice() * static_cast<std::size_t>(file.size.z) *
                               static_cast<std::size_t>(file.volumes) * bytes_of(file.number);
    file.first = std::max<std::int64_t>(0, size - static_cast<std::int64_t>(needed));
  }
}

std::optional<VoxelFile> open_meta_image(const std::filesystem::path& path, const std::filesystem::path& named) {
  if (!has_ending(named, ".mha") && !has_ending(named, ".mhd")) return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  const Fields fields = fields_in(stream);
  if (!fields.contains("ElementDataFile")) return std::nullopt;
  stream.clear();
  const std::vector<double> sizes = numbers(field(fields, {"DimSize"}));
  const std::string binary = field(fields, {"BinaryData"});
  const bool in_words = !binary.empty() && !is_true(binary);
  const bool has_frames = sizes.size() == 4;
  const std::size_t axes = has_frames ? 4 : 3;
  if (sizes.size() != axes || in_words || numbers(field(fields, {"NDims"})) != std::vector{static_cast<double>(axes)}) {
    throw DicomError(say("meta-image-of-another-kind"));
  }
  VoxelFile file;
  file.path = path;
  std::string type = field(fields, {"ElementType"});
  if (type.ends_with("_ARRAY")) type.resize(type.size() - std::string("_ARRAY").size());
  file.number = number_of(type);
  const std::vector<double> channels = numbers(field(fields, {"ElementNumberOfChannels"}));
  if (!channels.empty() && channels.front() != 1) read_as_colors(channels.front(), file);
  if (has_frames) file.volumes = count_of_volumes(sizes[3]);
  const bool is_big = is_true(field(fields, {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}));
  file.swapped = is_big == (std::endian::native == std::endian::little);
  const auto size = [&](std::size_t n) {
    return std::isfinite(sizes[n]) ? static_cast<int>(std::clamp(sizes[n], 0.0, 65535.0)) : 0;
  };
  remark_on_what_is_not_said(fields, file);
  place(map_of(fields, axes), {size(0), size(1), size(2)}, file);
  find_voxels(fields, static_cast<std::int64_t>(stream.tellg()), file);
  return file;
}

}  // namespace

extern const LabelFormat meta_image_format;
const LabelFormat meta_image_format{.name = "MetaImage",
                                    .endings = {".mha", ".mhd"},
                                    .open = open_meta_image,
                                    .written = {".mha"},
                                    .bytes = meta_image_bytes};

}  // namespace palpate::io
