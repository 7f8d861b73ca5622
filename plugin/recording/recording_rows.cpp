#include "plugin/recording/recording_rows.h"

#include <nlohmann/json.hpp>
#include <span>

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;
using hdf5::check;
using hdf5::Handle;

struct Member {
  const char* name;
  std::size_t offset;
  hid_t type;
  hsize_t count = 1;
};

Handle make_row_type(std::size_t size, std::span<const Member> members) {
  Handle row(H5Tcreate(H5T_COMPOUND, size), H5Tclose, "make-a-table");
  for (const Member& member : members) {
    if (member.count == 1) {
      check(H5Tinsert(row, member.name, member.offset, member.type), "make-a-table");
    } else {
      const Handle array(H5Tarray_create2(member.type, 1, &member.count), H5Tclose, "make-a-table");
      check(H5Tinsert(row, member.name, member.offset, array), "make-a-table");
    }
  }
  return row;
}

/// With a matrix as DICOM writes it (FrameOfReferenceTransformationMatrix): row by row. JSON keeps every bit of a
/// number.
Json json_of(const RegisteredStructure& registered) {
  Json matrix = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) matrix.push_back(registered.motion.turn[column][row]);
    matrix.push_back(registered.motion.shift[row]);
  }
  for (const double last : {0.0, 0.0, 0.0, 1.0}) matrix.push_back(last);
  return {{"structure", registered.structure}, {"file", registered.file_hash}, {"matrix", matrix}};
}

RegisteredStructure registered_structure(const Json& json) {
  RegisteredStructure registered{.structure = json.at("structure"), .file_hash = json.at("file"), .motion = {}};
  const Json& matrix = json.at("matrix");
  for (std::size_t row = 0; row < 3; ++row) {
    const auto axis = static_cast<int>(row);
    for (std::size_t column = 0; column < 3; ++column) {
      registered.motion.turn[static_cast<int>(column)][axis] = matrix.at(4 * row + column);
    }
    registered.motion.shift[axis] = matrix.at(4 * row + 3);
  }
  return registered;
}

/// A name from a file may not be UTF-8. This must not end a recording.
std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

Handle tick_row_type() {
  const hid_t f64 = H5T_NATIVE_DOUBLE;
  const hid_t u32 = H5T_NATIVE_UINT32;
  const Member members[] = {{"index", offsetof(TickRecord, index), H5T_NATIVE_UINT64},
                            {"time_s", offsetof(TickRecord, time_s), f64},
                            {"dt_s", offsetof(TickRecord, dt_s), f64},
                            {"pose_time_s", offsetof(TickRecord, pose_time_s), f64},
                            {"heartbeat_s", offsetof(TickRecord, heartbeat_s), f64},
                            {"probe_m", offsetof(TickRecord, probe_m), f64, 3},
                            {"proxy_m", offsetof(TickRecord, proxy_m), f64, 3},
                            {"force_n", offsetof(TickRecord, force_n), f64, 3},
                            {"sent_n", offsetof(TickRecord, sent_n), f64, 3},
                            {"value", offsetof(TickRecord, value), f64},
                            {"residual_n", offsetof(TickRecord, residual_n), f64},
                            {"error_bound_m", offsetof(TickRecord, error_bound_m), f64},
                            {"change_part", offsetof(TickRecord, change_part), f64},
                            {"distance_mm", offsetof(TickRecord, distance_mm), f64, distance_count},
                            {"scene_epoch", offsetof(TickRecord, scene_epoch), u32},
                            {"sub_steps", offsetof(TickRecord, sub_steps), u32},
                            {"halts", offsetof(TickRecord, halts), u32},
                            {"iterations", offsetof(TickRecord, iterations), u32},
                            {"solver", offsetof(TickRecord, solver), u32},
                            {"outcome", offsetof(TickRecord, outcome), u32},
                            {"safety", offsetof(TickRecord, safety), u32},
                            {"share_count", offsetof(TickRecord, share_count), u32},
                            {"buttons", offsetof(TickRecord, buttons), u32},
                            {"fresh", offsetof(TickRecord, fresh), u32},
                            {"stylus_state", offsetof(TickRecord, stylus_state), u32},
                            {"stylus_epoch", offsetof(TickRecord, stylus_epoch), u32},
                            {"commands", offsetof(TickRecord, commands), u32},
                            {"from_brick", offsetof(TickRecord, from_brick), u32},
                            {"missed", offsetof(TickRecord, missed), u32},
                            {"late_ns", offsetof(TickRecord, late_ns), u32},
                            {"stage_ns", offsetof(TickRecord, stage_ns), u32, stage_count}};
  return make_row_type(sizeof(TickRecord), members);
}

Handle share_row_type() {
  const Member members[] = {{"frame", offsetof(PrimitiveRecord, tick), H5T_NATIVE_UINT64},
                            {"mode", offsetof(PrimitiveRecord, mode), H5T_NATIVE_UINT32},
                            {"type", offsetof(PrimitiveRecord, type), H5T_NATIVE_UINT32},
                            {"strength_n", offsetof(PrimitiveRecord, strength_n), H5T_NATIVE_DOUBLE},
                            {"force_n", offsetof(PrimitiveRecord, force_n), H5T_NATIVE_DOUBLE, 3}};
  return make_row_type(sizeof(PrimitiveRecord), members);
}

Handle known_to_row_type() {
  return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose, "make-a-table"};
}

std::string to_line(const SceneRecord& scene) {
  Json json{{"kind", "scene"},
            {"epoch", scene.epoch},
            {"scan_hash", scene.scan_hash},
            {"half_extent_m", {scene.half_extent_m.x, scene.half_extent_m.y, scene.half_extent_m.z}},
            {"maximum_force_n", scene.maximum_force_n},
            {"change_s", scene.change_s},
            {"structures", scene.structures},
            {"scene", scene.scene}};
  for (const RegisteredStructure& one : scene.registered) json["registered"].push_back(json_of(one));
  if (scene.frame) json["frame"] = {{"number", scene.frame->number}, {"count", scene.frame->count}};
  return line_of(json);
}

std::string to_line(const StylusRecord& stylus) {
  const Json json{{"kind", "stylus"},
                  {"epoch", stylus.epoch},
                  {"name", stylus.name},
                  {"force_axes", stylus.force_axes},
                  {"maximum_force_n", stylus.maximum_force_n}};
  return line_of(json);
}

std::string to_line(const Gap& gap) {
  const Json json{{"kind", "gap"}, {"first_frame", gap.first_tick}, {"frames", gap.ticks}};
  return line_of(json);
}

void read_events(std::string_view lines, Recording& recording) {
  for (auto end = lines.find('\n'); end != std::string_view::npos; end = lines.find('\n')) {
    const Json json = Json::parse(lines.substr(0, end));
    lines.remove_prefix(end + 1);
    const auto& kind = json.at("kind").get_ref<const std::string&>();
    if (kind == "scene") {
      const auto& extent = json.at("half_extent_m");
      recording.scenes.push_back(
          {.epoch = json.at("epoch"),
           .scene = json.at("scene"),
           .scan_hash = json.at("scan_hash"),
           .half_extent_m = {extent.at(0).get<double>(), extent.at(1).get<double>(), extent.at(2).get<double>()},
           .maximum_force_n = json.at("maximum_force_n"),
           .change_s = json.value("change_s", SceneRecord{}.change_s),
           .structures = json.value("structures", std::vector<std::string>())});
      for (const Json& one : json.value("registered", Json::array())) {
        recording.scenes.back().registered.push_back(registered_structure(one));
      }
      if (const auto frame = json.find("frame"); frame != json.end()) {
        recording.scenes.back().frame = {.number = frame->at("number"), .count = frame->at("count")};
      }
    } else if (kind == "stylus") {
      recording.styluses.push_back({.epoch = json.at("epoch"),
                                    .name = json.at("name"),
                                    .force_axes = json.at("force_axes"),
                                    .maximum_force_n = json.at("maximum_force_n")});
    } else if (kind == "gap") {
      recording.gaps.push_back({.first_tick = json.at("first_frame"), .ticks = json.at("frames")});
    }
  }
}

}  // namespace palpate::plugin
