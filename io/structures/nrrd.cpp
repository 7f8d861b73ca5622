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
#include "io/messages.h"
#include "io/structures/color.h"
#include "io/structures/label_image.h"

namespace palpate::io {
namespace {

/// Fields ("sizes: 512 512 3") and key-value pairs ("Segment0_Name:=liver") by their names.
using Fields = std::map<std::string, std::string>;

std::string trimmed(const std::string& text) {
  const std::size_t from = text.find_first_not_of(" \t\r");
  return from == std::string::npos ? std::string() : text.substr(from, text.find_last_not_of(" \t\r") - from + 1);
}

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
  throw DicomError(say("labels-in-another-file"));
}

std::string field(const Fields& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? std::string() : found->second;
}

std::vector<double> numbers(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream words(text);
  std::vector<double> all;
  for (std::string word; words >> word;) all.push_back(std::strtod(word.c_str(), nullptr));
  return all;
}

LabelImage::Number number_of(const std::string& type) {
  using Number = LabelImage::Number;
  static const std::map<std::string, Number> types{
      {"uchar", Number::u8},         {"unsigned char", Number::u8},   {"uint8", Number::u8},
      {"uint8_t", Number::u8},       {"signed char", Number::i8},     {"int8", Number::i8},
      {"int8_t", Number::i8},        {"short", Number::i16},          {"short int", Number::i16},
      {"signed short", Number::i16}, {"int16", Number::i16},          {"int16_t", Number::i16},
      {"ushort", Number::u16},       {"unsigned short", Number::u16}, {"unsigned short int", Number::u16},
      {"uint16", Number::u16},       {"uint16_t", Number::u16},       {"int", Number::i32},
      {"signed int", Number::i32},   {"int32", Number::i32},          {"int32_t", Number::i32},
      {"uint", Number::u32},         {"unsigned int", Number::u32},   {"uint32", Number::u32},
      {"uint32_t", Number::u32},     {"float", Number::f32},          {"double", Number::f64}};
  const auto found = types.find(type);
  if (found == types.end()) {
    throw DicomError(say("labels-of-another-type"));
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

/// Slicer's: Segment0_Name, Segment0_LabelValue, Segment0_Color.
std::map<int, LabelName> names_in(const Fields& fields) {
  constexpr double most = 255;
  std::map<int, LabelName> names;
  for (int n = 0;; ++n) {
    const std::string segment = "Segment" + std::to_string(n) + "_";
    const auto name = fields.find(segment + "Name");
    if (name == fields.end()) return names;
    const std::vector<double> label = numbers(field(fields, segment + "LabelValue"));
    std::vector<double> rgb = numbers(field(fields, segment + "Color"));
    for (double& part : rgb) part *= most;
    const bool given = !label.empty() && std::isfinite(label.front());
    const int value = !given ? n + 1 : static_cast<int>(std::clamp(label.front(), 0.0, 65535.0));
    names[value] = {name->second, color_of_rgb(rgb)};
  }
}

}  // namespace

std::optional<LabelImage> open_nrrd(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic(4, '\0');
  if (!file.read(magic.data(), 4) || magic != "NRRD") return std::nullopt;
  std::string line;
  std::getline(file, line);
  const Fields fields = fields_in(file);
  LabelImage image;
  image.path = path;
  image.first = static_cast<std::int64_t>(file.tellg());
  if (!field(fields, "data file").empty() || !field(fields, "datafile").empty()) {
    throw DicomError(say("labels-in-another-file"));
  }
  const std::string encoding = field(fields, "encoding");
  image.packed_after = encoding == "gzip" || encoding == "gz";
  if (!image.packed_after && encoding != "raw") {
    throw DicomError(say("labels-in-another-encoding", encoding));
  }
  const std::vector<double> sizes = numbers(field(fields, "sizes"));
  const std::vector<double> directions = numbers(field(fields, "space directions"));
  const std::vector<double> origin = numbers(field(fields, "space origin"));
  if (sizes.size() != 3) throw DicomError(say("labels-in-several-volumes"));
  if (directions.size() != 9 || origin.size() != 3) to_lps({});
  image.number = number_of(field(fields, "type"));
  image.swapped = field(fields, "endian") == (std::endian::native == std::endian::little ? "big" : "little");
  image.names = names_in(fields);
  image.said_to_be_labels = !image.names.empty();
  const Vec3 sign = to_lps(field(fields, "space"));
  const auto direction = [&](std::size_t n) {
    return sign * Vec3(directions[3 * n], directions[3 * n + 1], directions[3 * n + 2]);
  };
  const auto size = [&](std::size_t n) {
    return std::isfinite(sizes[n]) ? static_cast<int>(std::clamp(sizes[n], 0.0, 65535.0)) : 0;
  };
  place(direction(0), direction(1), direction(2), sign * Vec3(origin[0], origin[1], origin[2]),
        {size(0), size(1), size(2)}, image);
  return image;
}

}  // namespace palpate::io
