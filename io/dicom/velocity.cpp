#include "io/dicom/velocity.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcitem.h>

#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <string_view>
#include <utility>

#include "io/dicom/dicom_value.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

double meters_per_second(const std::string& unit) {
  return unit == "m/s" ? 1 : unit == "cm/s" ? 1e-2 : unit == "mm/s" ? 1e-3 : 0;
}

bool is_magnitude(const std::string& image_type) {
  for (std::size_t at = 0; at < image_type.size();) {
    const std::size_t end = std::min(image_type.find('\\', at), image_type.size());
    const std::string_view word = std::string_view(image_type).substr(at, end - at);
    if (word == "M" || word.find("MAG") != std::string_view::npos) return true;
    at = end + 1;
  }
  return false;
}

struct NamedEncoding {
  std::vector<double> direction;
  double venc = 0;
};

std::optional<NamedEncoding> encoding_in(const std::string& sequence_name) {
  struct Axis {
    std::string_view name;
    std::vector<double> direction;  // LPS: to the left, to the back, to the head
  };
  static const std::array axes{Axis{"rl", {1, 0, 0}},  Axis{"lr", {-1, 0, 0}}, Axis{"ap", {0, 1, 0}},
                               Axis{"pa", {0, -1, 0}}, Axis{"fh", {0, 0, 1}},  Axis{"hf", {0, 0, -1}}};
  const std::size_t at = sequence_name.rfind("_v");
  if (at == std::string::npos) return std::nullopt;
  double venc = 0;
  const char* const end = sequence_name.data() + sequence_name.size();
  const auto parsed = std::from_chars(sequence_name.data() + at + 2, end, venc);
  const std::string_view name(parsed.ptr, static_cast<std::size_t>(end - parsed.ptr));
  for (const Axis& axis : axes) {
    if (parsed.ec == std::errc() && name == axis.name) return NamedEncoding{axis.direction, venc};
  }
  return std::nullopt;
}

bool same_grid(const Geometry& a, const Geometry& b) {
  constexpr double cosines = 1e-3;
  const double apart = 0.02 * std::min(a.spacing_i, a.spacing_j);
  if (a.dimensions != b.dimensions || std::abs(a.spacing_i - b.spacing_i) > 1e-4 * a.spacing_i ||
      std::abs(a.spacing_j - b.spacing_j) > 1e-4 * a.spacing_j ||
      glm::length(a.direction_i - b.direction_i) > cosines || glm::length(a.direction_j - b.direction_j) > cosines) {
    return false;
  }
  for (std::size_t k = 0; k < a.slice_positions.size(); ++k) {
    if (glm::distance(a.slice_positions[k], b.slice_positions[k]) > apart) return false;
  }
  return true;
}

/// All that was measured along one direction, in the order of its frames.
struct Direction {
  Vec3 along{0};
  std::vector<SeriesSource::Component> times;
  std::vector<std::string> names;
};

/// The velocity series of one study and grid.
struct Group {
  std::vector<const Series*> series;
  std::vector<Direction> directions;
};

Direction& direction_along(Group& group, const Vec3& along) {
  constexpr double alike = 0.99;
  for (Direction& known : group.directions) {
    if (glm::dot(known.along, along) > alike) return known;
  }
  return group.directions.emplace_back(Direction{along, {}, {}});
}

void add_frames(const Series& series, Group& group) {
  bool any = false;
  for (std::size_t f = 0; f < series.source->frames.size(); ++f) {
    const auto& slices = series.source->frames[f].slices;
    if (slices.empty()) continue;
    const auto& velocity = series.source->plane_of(slices.front()).velocity;
    if (!velocity) continue;
    Direction& direction = direction_along(group, velocity->direction);
    direction.times.push_back({series.source, f});
    direction.names.push_back(f < series.frame_names.size() ? series.frame_names[f] : "");
    any = true;
  }
  if (any) group.series.push_back(&series);
}

bool is_complete(const Group& group) {
  constexpr double least_volume = 0.5;  // of the box that the three directions span: 1 where they are perpendicular
  const auto& d = group.directions;
  return d.size() == 3 && d[0].times.size() == d[1].times.size() && d[0].times.size() == d[2].times.size() &&
         std::abs(glm::determinant(glm::dmat3(d[0].along, d[1].along, d[2].along))) > least_volume;
}

Series joined(const Group& group) {
  Series series = *group.series.front();
  series.unit = "m/s";
  series.warnings.clear();
  series.files.clear();
  series.uid.clear();
  series.description = "velocity of";
  for (const Series* part : group.series) {
    series.uid += (series.uid.empty() ? "" : "+") + part->uid;
    series.description += (part == group.series.front() ? " " : ", ") + part->description;
    series.files.insert(series.files.end(), part->files.begin(), part->files.end());
    for (const Text& warning : part->warnings) {
      const bool is_new = std::find(series.warnings.begin(), series.warnings.end(), warning) == series.warnings.end();
      if (is_new) series.warnings.push_back(warning);
    }
  }
  series.frames_per_position = static_cast<int>(group.directions[0].times.size());
  series.frame_names = group.directions[0].names;
  auto source = std::make_shared<SeriesSource>();
  for (std::size_t t = 0; t < group.directions[0].times.size(); ++t) {
    source->velocities.push_back(
        {group.directions[0].times[t], group.directions[1].times[t], group.directions[2].times[t]});
  }
  series.source = std::move(source);
  return series;
}

}  // namespace

std::optional<VelocityEncoding> velocity_of(const std::vector<double>& direction, std::optional<double> venc,
                                            const std::string& rescale_unit, const Plane& plane,
                                            const PixelFormat& format) {
  if (direction.size() < 3 || is_magnitude(plane.labels[static_cast<std::size_t>(Label::image_type)])) {
    return std::nullopt;
  }
  VelocityEncoding velocity;
  velocity.direction = {direction[0], direction[1], direction[2]};
  const double length = glm::length(velocity.direction);
  if (!(std::abs(length - 1) < 0.01)) return std::nullopt;
  velocity.direction /= length;
  if (const double unit = meters_per_second(rescale_unit); unit > 0) {
    velocity.slope = unit * plane.slope;
    velocity.intercept = unit * plane.intercept;
    return velocity;
  }
  if (!venc || !(*venc > 0)) return std::nullopt;
  const double half_range = std::ldexp(1.0, format.bits_stored - 1);
  velocity.slope = 1e-2 * *venc / half_range;
  velocity.intercept = format.is_signed ? 0 : -1e-2 * *venc;
  return velocity;
}

void read_classic_velocity(DcmItem& dataset, FileHeader& header, Plane& plane) {
  std::string& label = plane.labels[static_cast<std::size_t>(Label::velocity_encoding)];
  const std::string unit = text_of(dataset, DCM_RescaleType);
  plane.velocity = velocity_of(numbers_of(dataset, DCM_VelocityEncodingDirection),
                               number_of(dataset, DCM_VelocityEncodingMaximumValue), unit, plane, header.format);
  if (plane.velocity) {
    label = text_of(dataset, DCM_VelocityEncodingDirection);
  } else if (const auto named = encoding_in(text_of(dataset, DCM_SequenceName))) {
    plane.velocity = velocity_of(named->direction, named->venc, unit, plane, header.format);
    if (!plane.velocity) return;
    label = text_of(dataset, DCM_SequenceName);
    header.remarks.push_back(say("velocities-may-be-reversed"));
  }
}

std::vector<Series> join_velocities(const std::vector<Series>& all) {
  std::vector<Group> groups;
  for (const Series& series : all) {
    if (!series.usable || !series.source) continue;
    const auto fits = [&](const Group& group) {
      return !group.series.empty() && group.series.front()->study_uid == series.study_uid &&
             same_grid(group.series.front()->geometry, series.geometry);
    };
    const auto group = std::find_if(groups.begin(), groups.end(), fits);
    add_frames(series, group == groups.end() ? groups.emplace_back() : *group);
  }
  std::vector<Series> fields;
  for (const Group& group : groups) {
    if (is_complete(group)) fields.push_back(joined(group));
  }
  return fields;
}

Volume vector_field(std::array<Volume, 3> components, const std::array<Vec3, 3>& directions) {
  for (const Volume& component : components) {
    if (!same_grid(component.geometry, components[0].geometry)) {
      throw DicomError(say("velocity-directions-differ"));
    }
  }
  auto vectors = std::make_shared<VectorComponents>();
  vectors->to_patient = glm::inverse(glm::transpose(glm::dmat3(directions[0], directions[1], directions[2])));
  Volume field;
  field.geometry = components[0].geometry;
  field.modality = components[0].modality;
  field.unit = "m/s";
  for (std::size_t n = 0; n < 3; ++n) {
    field.warnings.insert(field.warnings.end(), components[n].warnings.begin(), components[n].warnings.end());
    vectors->along[n] = std::make_shared<const Volume>(std::move(components[n]));
  }
  constexpr float outside = std::numeric_limits<float>::lowest();
  field.padding = {outside, outside};
  const glm::ivec3 size = field.geometry.dimensions;
  std::vector<float> speeds(field.offset(0, 0, size.z));
  auto speed = speeds.begin();
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        Vec3 along(0);
        bool padding = false;
        for (std::size_t n = 0; n < 3; ++n) {
          along[static_cast<int>(n)] = vectors->along[n]->value_at(i, j, k);
          padding = padding || vectors->along[n]->is_padding(i, j, k);
        }
        *speed++ = padding ? outside : static_cast<float>(glm::length(vectors->to_patient * along));
      }
    }
  }
  field.voxels = std::move(speeds);
  field.vectors = std::move(vectors);
  return field;
}

}  // namespace palpate::io::internal
