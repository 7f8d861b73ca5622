#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <map>
#include <optional>
#include <sstream>
#include <vector>

#include "io/errors.h"
#include "io/interchange/header_text.h"
#include "io/interchange/label_bytes.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/color.h"
#include "solver/text/utf8.h"

namespace palpate::io {
namespace {

constexpr double most_layers = 255;

/// Fields ("sizes: 512 512 3") and key-value pairs ("Segment0_Name:=liver") by their names.
using Fields = HeaderFields;

Fields nrrd_fields(std::istream& file) {
  Fields fields;
  std::string line;
  for (HeaderLines lines(file); lines.next(line);) {
    if (trimmed(line).empty()) return fields;
    const std::size_t colon = line.find(':');
    if (line.front() == '#' || colon == std::string::npos) continue;
    const bool pair = colon + 1 < line.size() && line[colon + 1] == '=';
    const std::string name = trimmed(line.substr(0, colon));
    fields[pair ? name : lower_case(name)] = trimmed(line.substr(colon + (pair ? 2 : 1)));
  }
  return fields;  // a header alone ends where its file does
}

VoxelFile::Number nrrd_number(const std::string& type) {
  using Number = VoxelFile::Number;
  // https://teem.sourceforge.net/nrrd/format.html, 5
  static const std::map<std::string, Number> types = [] {
    std::map<std::string, Number> all;
    const auto add = [&](Number number, std::initializer_list<const char*> names) {
      for (const char* const name : names) all[name] = number;
    };
    add(Number::i8, {"signed char", "int8", "int8_t"});
    add(Number::u8, {"uchar", "unsigned char", "uint8", "uint8_t"});
    add(Number::i16, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
    add(Number::u16, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
    add(Number::i32, {"int", "signed int", "int32", "int32_t"});
    add(Number::u32, {"uint", "unsigned int", "uint32", "uint32_t"});
    add(Number::i64,
        {"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"});
    add(Number::u64, {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
    add(Number::f32, {"float"});
    add(Number::f64, {"double"});
    return all;
  }();
  const auto found = types.find(lower_case(type));
  if (found == types.end()) {
    throw DicomError(say("voxels-of-another-type"));
  }
  return found->second;
}

/// From the file's space to LPS. It may have an axis of time behind its three ("left-posterior-superior-time", "LPST").
Vec3 to_lps(const std::string& given) {
  std::string space = lower_case(given);
  if (space.ends_with("-time")) space.resize(space.size() - std::string("-time").size());
  if (space == "left-posterior-superior" || space == "lps" || space == "lpst") return {1, 1, 1};
  if (space == "right-anterior-superior" || space == "ras" || space == "rast") return {-1, -1, 1};
  if (space == "left-anterior-superior" || space == "las" || space == "last") return {1, -1, 1};
  throw DicomError(say("nrrd-without-a-place"));
}

/// The spatial part of a vector in the file's space; nothing if it has none, or is not such a vector.
std::optional<Vec3> in_space(const std::vector<double>& vector) {
  if (vector.size() != 3 && vector.size() != 4) return std::nullopt;
  const Vec3 part(vector[0], vector[1], vector[2]);
  const double time = vector.size() == 4 ? vector[3] : 0;
  const bool is_sound = std::isfinite(part.x) && std::isfinite(part.y) && std::isfinite(part.z) && std::isfinite(time);
  if (!is_sound || (time != 0 && part == Vec3(0))) return std::nullopt;
  if (time != 0) throw DicomError(say("voxels-on-no-lattice"));
  return part;
}

double mm_of(const std::string& unit) {
  // Both signs for a millionth: the micro sign and the Greek letter.
  static const std::map<std::string, double> units{{"", 1},
                                                   {"mm", 1},
                                                   {"millimeter", 1},
                                                   {"millimeters", 1},
                                                   {"um", 1e-3},
                                                   {"\u00b5m", 1e-3},
                                                   {"\u03bcm", 1e-3},
                                                   {"micron", 1e-3},
                                                   {"microns", 1e-3},
                                                   {"micrometer", 1e-3},
                                                   {"micrometers", 1e-3},
                                                   {"nm", 1e-6},
                                                   {"cm", 10},
                                                   {"m", 1000},
                                                   {"meter", 1000},
                                                   {"meters", 1000}};
  const auto found = units.find(lower_case(unit));
  if (found == units.end()) throw DicomError(say("nrrd-of-another-unit", unit));
  return found->second;
}

/// "space units": a quoted unit for each axis of the space; mm if missing.
Vec3 mm_along_axes(const Fields& fields) {
  const std::string text = field(fields, {"space units"});
  constexpr char quote = '\x22';
  Vec3 mm(1);
  std::size_t at = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t open = text.find(quote, at), close = text.find(quote, open + 1);
    if (open == std::string::npos || close == std::string::npos) break;
    mm[axis] = mm_of(trimmed(text.substr(open + 1, close - open - 1)));
    at = close + 1;
  }
  return mm;
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
    names[label_number(in_layer, value)] = {utf8_text(name->second), color_of_rgb(rgb)};
  }
}

/// The direction of each axis in the file's space; nothing for a non-spatial axis.
std::vector<std::optional<Vec3>> directions_of(const Fields& fields) {
  const std::string text = field(fields, {"space directions"});
  std::vector<std::optional<Vec3>> directions;
  for (std::size_t at = text.find_first_of("(n"); at != std::string::npos; at = text.find_first_of("(n", at)) {
    const std::size_t end = text[at] == '(' ? text.find(')', at) : text.find_first_of(" (", at);
    const std::vector<double> all = text[at] == '(' ? numbers(text.substr(at, end - at)) : std::vector<double>();
    directions.push_back(in_space(all));
    if (end == std::string::npos) break;
    at = end;
  }
  return directions;
}

/// The axes of a file: three in space, and at most one other axis, as the fastest or the slowest.
struct Axes {
  std::vector<double> sizes;  ///< of those in space
  std::vector<Vec3> along;
  std::optional<std::size_t> other;
  double count = 1;  ///< along the other
};

Axes axes_of(const Fields& fields) {
  const std::vector<double> sizes = numbers(field(fields, {"sizes"}));
  const auto directions = directions_of(fields);
  if (sizes.size() != 3 && sizes.size() != 4) throw DicomError(say("labels-in-several-volumes"));
  if (directions.size() != sizes.size()) to_lps({});
  Axes axes;
  for (std::size_t n = 0; n < sizes.size(); ++n) {
    if (directions[n]) {
      axes.sizes.push_back(sizes[n]);
      axes.along.push_back(*directions[n]);
    } else if (axes.other) {
      to_lps({});
    } else {
      axes.other = n;
      axes.count = sizes[n];
    }
  }
  if (axes.sizes.size() != 3) to_lps({});
  return axes;
}

// The meaning of the other axis: consecutive volumes if it is the slowest; if it is the fastest, layers of labels,
// parts of a color, or volumes, depending on its kind.
void read_other_axis(const Fields& fields, const Axes& axes, VoxelFile& file) {
  if (!axes.other) return;
  const bool are_layers = *axes.other == 0 && fields.contains("Segment0_Layer");
  std::istringstream kinds(lower_case(field(fields, {"kinds"})));
  std::string kind;
  for (std::size_t n = 0; n <= *axes.other; ++n) kinds >> kind;
  if (*axes.other == 3) {
    file.volumes = count_of_volumes(axes.count);
  } else if (are_layers && axes.count >= 1 && axes.count <= most_layers) {
    file.layers = static_cast<int>(axes.count);
  } else if (*axes.other == 0 && (kind == "rgb-color" || kind == "rgba-color")) {
    read_as_colors(axes.count, file);
  } else if (*axes.other == 0 && (kind == "list" || kind == "time") && axes.count <= most_layers) {
    file.layers = count_of_volumes(axes.count);
    file.beside = VoxelFile::Beside::volumes;
  } else {
    throw DicomError(say("voxels-have-several-values", static_cast<int>(std::clamp(axes.count, 0.0, 1e6))));
  }
}

VoxelMap map_of(const Fields& fields, const Axes& axes) {
  const std::vector<double> origin = numbers(field(fields, {"space origin"}));
  if (origin.size() != 3 && origin.size() != 4) to_lps({});
  const Vec3 mm = to_lps(field(fields, {"space"})) * mm_along_axes(fields);
  VoxelMap map;
  for (std::size_t n = 0; n < 3; ++n) map.along[n] = mm * axes.along[n];
  map.first = mm * Vec3(origin[0], origin[1], origin[2]);
  return map;
}

VoxelFile::Packing packing_of(const std::string& encoding) {
  using Packing = VoxelFile::Packing;
  static const std::map<std::string, Packing> all{
      {"raw", Packing::none},    {"gzip", Packing::behind_it}, {"gz", Packing::behind_it},
      {"bzip2", Packing::bzip2}, {"bz2", Packing::bzip2},      {"ascii", Packing::ascii},
      {"text", Packing::ascii},  {"txt", Packing::ascii},      {"hex", Packing::hex}};
  const auto found = all.find(lower_case(encoding));
  if (found == all.end()) throw DicomError(say("voxels-in-another-encoding", encoding));
  return found->second;
}

// Where the voxels are: behind the header, which ends at `header_end`, or in a file beside it.
void find_nrrd_voxels(const Fields& fields, std::int64_t header_end, VoxelFile& file) {
  const std::string data = field(fields, {"data file", "datafile"});
  file.voxels_at = data.empty() ? file.path : beside(file.path, data);
  file.first = data.empty() ? header_end : 0;
  file.packing = packing_of(field(fields, {"encoding"}));
  const bool packed = file.packing != VoxelFile::Packing::none;
  if (file.packing == VoxelFile::Packing::ascii) file.swapped = false;
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
                                                  static_cast<std::size_t>(file.volumes) * bytes_of(file.number));
    std::error_code ignored;
    file.first = std::max<std::int64_t>(
        0, static_cast<std::int64_t>(std::filesystem::file_size(file.voxels_at, ignored)) - needed);
  } else {
    file.first += static_cast<std::int64_t>(bytes);
  }
}

std::optional<VoxelFile> open_nrrd(const std::filesystem::path& path, const std::filesystem::path&) {
  std::ifstream stream(path, std::ios::binary);
  std::string magic(4, '\0');
  if (!stream.read(magic.data(), 4) || magic != "NRRD") return std::nullopt;
  std::string line;
  std::getline(stream, line);
  const Fields fields = nrrd_fields(stream);
  stream.clear();  // a header alone may end without an empty line
  VoxelFile file;
  file.path = path;
  const auto header_end = static_cast<std::int64_t>(stream.tellg());
  file.number = nrrd_number(field(fields, {"type"}));
  file.swapped =
      lower_case(field(fields, {"endian"})) == (std::endian::native == std::endian::little ? "big" : "little");
  file.names = names_in(fields);
  file.said_to_be_labels = !file.names.empty();
  const Axes axes = axes_of(fields);
  read_other_axis(fields, axes, file);
  glm::ivec3 size(0);
  for (int n = 0; n < 3; ++n) {
    const double one = axes.sizes[static_cast<std::size_t>(n)];
    if (std::isfinite(one)) size[n] = static_cast<int>(std::clamp(one, 0.0, 65535.0));
  }
  place(map_of(fields, axes), size, file);
  find_nrrd_voxels(fields, header_end, file);
  return file;
}

}  // namespace

extern const LabelFormat nrrd_format;
const LabelFormat nrrd_format{.name = "NRRD",
                              .endings = {".nrrd", ".nhdr"},
                              .open = open_nrrd,
                              .written = {".seg.nrrd", ".nrrd"},
                              .bytes = nrrd_bytes};

}  // namespace palpate::io
