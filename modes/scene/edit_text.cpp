#include "modes/scene/edit_text.h"

#include <array>
#include <fstream>
#include <sstream>
#include <variant>

#include "modes/messages.h"
#include "modes/scene/edit_json.h"
#include "modes/scene/json_text.h"

namespace palpate::modes {
namespace {

template <typename Item, typename Read>
std::vector<Item> each_of(const At& at, const Read& read) {
  std::vector<Item> items;
  const std::size_t count = length_of_array(at);
  items.reserve(count);
  for (std::size_t i = 0; i < count; ++i) items.push_back(read(at[i]));
  return items;
}

std::vector<io::Vec3> places(const At& at) {
  return each_of<io::Vec3>(at, vector3);
}

io::Tube read_tube(Members& members) {
  return {.path_mm = places(members.get("path_mm")), .radius_mm = number(members.get("radius_mm"))};
}

io::Edit read_trace(Members& members) {
  io::TraceEdit edit;
  edit.points_mm = places(members.get("points_mm"));
  members.optional("known_to_mm", edit.known_to_mm, [](const At& at) { return each_of<double>(at, number); });
  members.optional("reach_mm", edit.reach_mm, number);
  return edit;
}

io::Edit read_add(Members& members) {
  return io::AddEdit{read_tube(members)};
}

io::Edit read_remove(Members& members) {
  return io::RemoveEdit{read_tube(members)};
}

io::Edit read_scan_edge(Members& members) {
  return io::ScanEdgeEdit{.center_mm = vector3(members.get("center_mm")),
                          .radius_mm = number(members.get("radius_mm")),
                          .most_mm = number(members.get("most_mm"))};
}

io::Edit read_contours(Members& members) {
  return io::ContoursEdit{each_of<std::vector<io::Vec3>>(members.get("loops_mm"), places)};
}

io::Edit read_edit(const At& at) {
  // In the order of io::Edit, by whose names they are chosen.
  constexpr std::array readers{read_trace, read_add, read_remove, read_scan_edge, read_contours};
  static_assert(readers.size() == std::variant_size_v<io::Edit>);
  const std::array<io::Edit, readers.size()> kinds{io::TraceEdit{}, io::AddEdit{}, io::RemoveEdit{}, io::ScanEdgeEdit{},
                                                   io::ContoursEdit{}};
  Members members(at);
  const std::string type = text(members.get("type"));
  std::string known;
  for (std::size_t n = 0; n < readers.size(); ++n) {
    const char* name = io::name_of(kinds[n]);
    if (name == type) {
      io::Edit edit = readers[n](members);
      members.done();
      return edit;
    }
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  refuse(members.path_of("type"), say("there-is-no-such-name", type, known));
}

using Json = nlohmann::ordered_json;

Json json_of_places(const std::vector<io::Vec3>& places) {
  Json json = Json::array();
  for (const io::Vec3& at : places) json.push_back({at.x, at.y, at.z});
  return json;
}

Json json_of_edit(const io::TraceEdit& edit) {
  Json json{{"points_mm", json_of_places(edit.points_mm)}};
  if (!edit.known_to_mm.empty()) json["known_to_mm"] = edit.known_to_mm;
  json["reach_mm"] = edit.reach_mm;
  return json;
}

Json json_of_edit(const io::AddEdit& edit) {
  return {{"path_mm", json_of_places(edit.tube.path_mm)}, {"radius_mm", edit.tube.radius_mm}};
}

Json json_of_edit(const io::RemoveEdit& edit) {
  return {{"path_mm", json_of_places(edit.tube.path_mm)}, {"radius_mm", edit.tube.radius_mm}};
}

Json json_of_edit(const io::ScanEdgeEdit& edit) {
  return {{"center_mm", {edit.center_mm.x, edit.center_mm.y, edit.center_mm.z}},
          {"radius_mm", edit.radius_mm},
          {"most_mm", edit.most_mm}};
}

Json json_of_edit(const io::ContoursEdit& edit) {
  Json loops = Json::array();
  for (const std::vector<io::Vec3>& loop : edit.loops_mm) loops.push_back(json_of_places(loop));
  return {{"loops_mm", std::move(loops)}};
}

}  // namespace

std::vector<io::Edit> edits_at(const At& at) {
  return each_of<io::Edit>(at, read_edit);
}

Json json_of_edits(const std::vector<io::Edit>& edits) {
  Json json = Json::array();
  for (const io::Edit& edit : edits) {
    Json entry{{"type", io::name_of(edit)}};
    entry.update(std::visit([](const auto& one) { return json_of_edit(one); }, edit));
    json.push_back(std::move(entry));
  }
  return json;
}

std::string to_json(const std::vector<io::Edit>& edits) {
  return Json{{"version", edit_text_version}, {"edits", json_of_edits(edits)}}.dump();
}

std::vector<io::Edit> edits_from_json(std::string_view text, const std::string& source) {
  return read_from(source, [&] {
    const nlohmann::json json = parsed(text);
    Members members({json, ""}, "edits");
    const int version = integer(members.get("version"));
    if (version != edit_text_version) refuse("version", say("not-known", version, edit_text_version));
    std::vector<io::Edit> edits = edits_at(members.get("edits"));
    members.done();
    return edits;
  });
}

std::vector<io::Edit> load_edits(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file, ignored)) {
    throw InvalidInput(say("no-such-edits-can-be-read", file.string()));
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return edits_from_json(text.str(), file.string());
}

}  // namespace palpate::modes
