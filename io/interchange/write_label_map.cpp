// Label maps as NIfTI-1, NRRD and MetaImage, which nifti.cpp, nrrd.cpp and meta_image.cpp can read.

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "io/errors.h"
#include "io/interchange/label_bytes.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/color.h"
#include "io/structures/label_image.h"
#include "io/structures/write_checks.h"
#include "io/whole_file.h"

namespace palpate::io {
namespace {

enum class Wrapping { zlib, gzip };

std::string packed(const std::string& bytes, Wrapping wrapping) {
  constexpr int with_gzip_header = 16, fast = 3, memory = 8;
  z_stream stream{};
  const int window = MAX_WBITS + (wrapping == Wrapping::gzip ? with_gzip_header : 0);
  if (deflateInit2(&stream, fast, Z_DEFLATED, window, memory, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string result(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // NOLINT: zlib does not write there
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

std::string voxels_of(const LabelImage& image) {
  return {image.inside.begin(), image.inside.end()};
}

/// From a voxel to the next along each axis, LPS, mm.
std::array<Vec3, 3> steps_of(const Geometry& geometry) {
  return {geometry.spacing_i * geometry.direction_i, geometry.spacing_j * geometry.direction_j, geometry.step};
}

/// On one line.
std::string line_of(std::string text) {
  for (char& c : text) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  return text;
}

std::array<int, 3> color_of(const StructureLabel& label) {
  constexpr std::array tissue{128, 174, 128};  // Slicer's, where nobody says more
  return rgb_of_color(label.color).value_or(tissue);
}

/// The table of names that nifti.cpp reads, in an extension of its own.
std::string nifti_extension(const StructureLabel& label) {
  std::string name = line_of(label.name);
  for (std::size_t at = name.find("]]>"); at != std::string::npos; at = name.find("]]>")) name.replace(at, 3, "]] >");
  const auto [red, green, blue] = color_of(label);
  constexpr double most = 255;
  std::string text =
      fmt::format(R"(<?xml version="1.0" encoding="UTF-8"?><CaretExtension><VolumeInformation Index="0"><LabelTable>)"
                  R"(<Label Key="1" Red="{:.6f}" Green="{:.6f}" Blue="{:.6f}" Alpha="1"><![CDATA[{}]]></Label>)"
                  R"(</LabelTable></VolumeInformation></CaretExtension>)",
                  red / most, green / most, blue / most, name);
  constexpr std::size_t head = 8, unit = 16;
  text.resize((text.size() + head + unit - 1) / unit * unit - head, '\0');
  return text;
}

/// With a header, and not packed.
std::string plain_nifti(const LabelImage& image) {
  constexpr std::size_t header_bytes = 352;
  std::string bytes(header_bytes, '\0');
  const auto put = [&](std::size_t at, const auto& value) { std::memcpy(bytes.data() + at, &value, sizeof value); };
  const auto put_float = [&](std::size_t at, double value) { put(at, static_cast<float>(value)); };
  const Geometry& geometry = image.geometry;
  const Vec3 to_ras(-1, -1, 1);
  const auto along = steps_of(geometry);
  // nifti1.h
  put(0, std::int32_t{348});
  put(40, std::int16_t{3});
  for (std::size_t n = 0; n < 7; ++n) {
    put(42 + 2 * n, static_cast<std::int16_t>(n < 3 ? geometry.dimensions[static_cast<int>(n)] : 1));
  }
  constexpr std::int16_t labels = 1002, bytes_without_sign = 2, bits = 8, scanner = 1;
  put(68, labels);
  put(70, bytes_without_sign);
  put(72, bits);
  put_float(76, 1);
  for (std::size_t n = 0; n < 3; ++n) put_float(80 + 4 * n, glm::length(along[n]));
  put_float(112, 1);
  bytes[123] = 2;  // mm
  std::snprintf(bytes.data() + 148, 80, "Palpate");
  glm::dmat3 axes;
  for (int n = 0; n < 3; ++n) axes[n] = glm::normalize(to_ras * along[static_cast<std::size_t>(n)]);
  constexpr double square = 1e-4;
  const Vec3 first = to_ras * geometry.slice_positions.front();
  if (std::abs(glm::dot(axes[0], axes[2])) < square && std::abs(glm::dot(axes[1], axes[2])) < square) {
    glm::dquat turn = glm::quat_cast(axes);
    if (turn.w < 0) turn = -turn;
    put(252, scanner);
    put_float(256, turn.x);
    put_float(260, turn.y);
    put_float(264, turn.z);
    for (int n = 0; n < 3; ++n) put_float(268 + 4 * static_cast<std::size_t>(n), first[n]);
  }
  put(254, scanner);
  for (int row = 0; row < 3; ++row) {
    const std::size_t at = 280 + 16 * static_cast<std::size_t>(row);
    for (std::size_t n = 0; n < 3; ++n) put_float(at + 4 * n, (to_ras * along[n])[row]);
    put_float(at + 12, first[row]);
  }
  std::memcpy(bytes.data() + 344, "n+1", 4);
  bytes[348] = 1;  // an extension follows
  const std::string extension = nifti_extension(image.label);
  constexpr std::int32_t of_workbench = 30, head = 8;
  const auto extension_bytes = static_cast<std::int32_t>(extension.size()) + head;
  put_float(108, static_cast<double>(header_bytes) + extension_bytes);
  bytes.resize(header_bytes + head);
  put(header_bytes, extension_bytes);
  put(header_bytes + 4, of_workbench);
  return bytes + extension + voxels_of(image);
}

std::string in_parentheses(const Vec3& v) {
  return fmt::format("({},{},{})", v.x, v.y, v.z);
}

/// As 3D Slicer writes and reads it.
std::string segment_fields(const LabelImage& image) {
  const auto code = [](const Code& one) { return one.scheme + "^" + one.value + "^" + one.meaning; };
  const StructureLabel& label = image.label;
  const Code tissue{"85756007", "SCT", "Tissue"};
  const Code& category = label.category.value.empty() ? tissue : label.category;
  const Code& type = label.type.value.empty() ? tissue : label.type;
  const std::string modifier = label.modifiers.empty() ? "^^" : code(label.modifiers.front());
  const auto [red, green, blue] = color_of(label);
  constexpr double most = 255;
  const glm::ivec3 last = image.geometry.dimensions - 1;
  return fmt::format(
      "Segment0_ID:=Segment_1\nSegment0_Name:={}\nSegment0_NameAutoGenerated:=0\n"
      "Segment0_Color:={:.6f} {:.6f} {:.6f}\nSegment0_ColorAutoGenerated:=0\n"
      "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Extent:=0 {} 0 {} 0 {}\n"
      "Segment0_Tags:={}\n"
      "Segmentation_ContainedRepresentationNames:=Binary labelmap|\n"
      "Segmentation_MasterRepresentation:=Binary labelmap\nSegmentation_ReferenceImageExtentOffset:=0 0 0\n",
      line_of(label.name), red / most, green / most, blue / most, last.x, last.y, last.z,
      line_of(fmt::format("Segmentation.Status:inprogress|TerminologyEntry:Segmentation category and type - 3D Slicer "
                          "General Anatomy list~{}~{}~{}~Anatomic codes - DICOM master list~^^~^^|",
                          code(category), code(type), modifier)));
}

}  // namespace

std::string nifti_bytes(const LabelImage& image, std::string_view ending) {
  std::string bytes = plain_nifti(image);
  return ending == ".nii.gz" ? packed(bytes, Wrapping::gzip) : bytes;
}

std::string nrrd_bytes(const LabelImage& image, std::string_view ending) {
  const Geometry& geometry = image.geometry;
  const auto along = steps_of(geometry);
  const glm::ivec3& n = geometry.dimensions;
  return fmt::format(
             "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
             "space directions: {} {} {}\nkinds: domain domain domain\nencoding: gzip\nspace origin: {}\n",
             n.x, n.y, n.z, in_parentheses(along[0]), in_parentheses(along[1]), in_parentheses(along[2]),
             in_parentheses(geometry.slice_positions.front())) +
         (ending == ".seg.nrrd" ? segment_fields(image) : "") + "\n" + packed(voxels_of(image), Wrapping::gzip);
}

std::string meta_image_bytes(const LabelImage& image, std::string_view /*ending*/) {
  const Geometry& geometry = image.geometry;
  std::string rows, spacing;
  for (const Vec3& along : steps_of(geometry)) {
    const double length = glm::length(along);
    rows += fmt::format(" {} {} {}", along.x / length, along.y / length, along.z / length);
    spacing += fmt::format(" {}", length);
  }
  const Vec3& first = geometry.slice_positions.front();
  const glm::ivec3& n = geometry.dimensions;
  const std::string voxels = packed(voxels_of(image), Wrapping::zlib);
  return fmt::format(
             "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = True\n"
             "CompressedDataSize = {}\nTransformMatrix ={}\nOffset = {} {} {}\nCenterOfRotation = 0 0 0\n"
             "ElementSpacing ={}\nDimSize = {} {} {}\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
             voxels.size(), rows, first.x, first.y, first.z, spacing, n.x, n.y, n.z) +
         voxels;
}

void write_label_map(const LabelImage& image, const std::filesystem::path& file, const WriteOptions& options) {
  check_target(image.label, file, options);
  occupied_slices(image);
  if (!image.geometry.uniform || !image.geometry.gaps.empty()) {
    throw DicomError(say("slices-lie-unevenly-for-it", file.filename().string()));
  }
  const auto writer = writer_of(file);
  if (!writer) throw_no_known_ending(file);
  write_whole(file, writer->format->bytes(image, writer->ending), existing(options));
}

}  // namespace palpate::io
