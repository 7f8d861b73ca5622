#include "plugin/paraview/wire/slices_message.h"

#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include "io/errors.h"
#include "modes/scene/starting_scene.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/common/scan_store.h"
#include "plugin/session/scan_hash.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {
namespace {

using nlohmann::json;

json numbers(const glm::dvec3& v) {
  return {v.x, v.y, v.z};
}
glm::dvec3 vector(const json& from) {
  return {from.at(0), from.at(1), from.at(2)};
}

json json_of(const io::Geometry& g) {
  json positions = json::array();
  for (const glm::dvec3& position : g.slice_positions) positions.push_back(numbers(position));
  return {{"dimensions", {g.dimensions.x, g.dimensions.y, g.dimensions.z}},
          {"direction_i", numbers(g.direction_i)},
          {"direction_j", numbers(g.direction_j)},
          {"spacing", {g.spacing_i, g.spacing_j}},
          {"slice_positions", positions},
          {"step", numbers(g.step)},
          {"uniform", g.uniform},
          {"gaps", g.gaps}};
}

io::Geometry geometry_of(const json& from) {
  io::Geometry g;
  const json& size = from.at("dimensions");
  g.dimensions = {size.at(0), size.at(1), size.at(2)};
  g.direction_i = vector(from.at("direction_i"));
  g.direction_j = vector(from.at("direction_j"));
  g.spacing_i = from.at("spacing").at(0);
  g.spacing_j = from.at("spacing").at(1);
  for (const json& position : from.at("slice_positions")) g.slice_positions.push_back(vector(position));
  g.step = vector(from.at("step"));
  g.uniform = from.at("uniform");
  g.gaps = from.at("gaps").get<std::vector<int>>();
  if (g.dimensions.x < 1 || g.dimensions.y < 1 || g.dimensions.z != static_cast<int>(g.slice_positions.size())) {
    throw InvalidInput(say("no-scan-has-this-size"));
  }
  return g;
}

/// A copy of some slices.
io::Volume::Voxels voxels_of(const io::Volume& volume, int first, int count) {
  return std::visit(
      [&](const auto& voxels) -> io::Volume::Voxels {
        const auto begin = voxels.begin() + static_cast<std::ptrdiff_t>(volume.offset(0, 0, first));
        return std::decay_t<decltype(voxels)>(begin, begin + static_cast<std::ptrdiff_t>(volume.offset(0, 0, count)));
      },
      volume.voxels);
}

/// The whole frame if it is in the store, or cannot be read in parts.
std::shared_ptr<const io::Volume> whole_of(const io::Series& series, int frame) {
  const auto held = held_scan(series, frame);
  return held || series.frames_per_position == 1 ? held : load_scan(series, frame);
}

/// The whole scan's data without its voxels; for a scan read in parts, from one slice and the series' geometry.
io::Volume head_of(const io::Series& series) {
  io::Volume head = *load_slice(series, 0);
  head.geometry = series.geometry;
  return head;
}

}  // namespace

std::string text_of_head(const io::Volume& volume) {
  json head{{"geometry", json_of(volume.geometry)},
            {"rescale", {volume.slope, volume.intercept}},
            {"unit", volume.unit},
            {"modality", volume.modality},
            {"body_part", modes::part_of_body(volume)},
            {"frame_of_reference_uid", volume.frame_of_reference_uid},
            {"patient", {hashed_id(volume.patient_id), hashed_name(volume.patient_name)}}};
  if (volume.padding) head["padding"] = {volume.padding->first, volume.padding->second};
  return head.dump();
}

io::Volume volume_of_head(const std::string& text) {
  try {
    const json head = json::parse(text);
    io::Volume volume;
    volume.geometry = geometry_of(head.at("geometry"));
    volume.slope = head.at("rescale").at(0);
    volume.intercept = head.at("rescale").at(1);
    volume.unit = head.at("unit");
    volume.modality = head.at("modality");
    volume.body_part = head.value("body_part", "");
    volume.frame_of_reference_uid = head.at("frame_of_reference_uid");
    volume.patient_id = head.at("patient").at(0);
    volume.patient_name = head.at("patient").at(1);
    if (head.contains("padding")) volume.padding = {head.at("padding").at(0), head.at("padding").at(1)};
    return volume;
  } catch (const std::exception& error) {
    throw InvalidInput(say("what-the-server-says-of-the-scan", error.what()));
  }
}

SlicesAnswered answer(const io::Series& series, const SlicesAsked& asked) {
  SlicesAnswered answered;
  try {
    if (asked.frame < 0 || asked.frame >= series.frames_per_position) {
      throw Refusal(say("scan-has-no-such-slices"));
    }
    const auto whole = whole_of(series, asked.frame);
    if (asked.what == SlicesAsked::What::head) {
      answered.head = text_of_head(whole ? *whole : head_of(series));
      return answered;
    }
    const auto some = whole ? whole : load_slices(series, asked.first, asked.count);
    // The whole scan would differ from the one assembled from the remaining slices.
    if (!whole && some->geometry.dimensions.z != asked.count) throw io::DicomError(some->warnings.front());
    const int first = whole ? asked.first : 0;
    if (first < 0 || asked.count < 1 || asked.count > some->geometry.dimensions.z - first) {
      throw Refusal(say("scan-has-no-such-slices"));
    }
    for (int k = first; k < first + asked.count; ++k) answered.hashes.push_back(hash_of_slice(*some, k));
    if (asked.what == SlicesAsked::What::voxels) answered.voxels = voxels_of(*some, first, asked.count);
  } catch (const std::exception& error) {
    answered = {};
    answered.error = error.what();
  }
  return answered;
}

}  // namespace palpate::plugin
