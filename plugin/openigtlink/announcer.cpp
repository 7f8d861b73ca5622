#include "plugin/openigtlink/announcer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "device/safety/safety_filter.h"
#include "modes/scene/scene_json.h"
#include "plugin/messages/tell.h"
#include "plugin/openigtlink/marks.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/say.h"
#include "plugin/report/held_boundary.h"
#include "plugin/report/live_view.h"
#include "plugin/structures/same_space.h"

namespace palpate::plugin::igtl {
namespace {

constexpr auto between_status = std::chrono::seconds(1);
constexpr auto between_contacts = std::chrono::milliseconds(100);
constexpr auto tuning = std::chrono::milliseconds(500);

nlohmann::ordered_json number_or_null(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

}  // namespace

StateInWords state_of_session(const TickRecord& tick) {
  if (const device::Fault fault = fault_of(tick); fault != device::Fault::none) {
    return {"stopped", "Stopped: " + device::advice_for(fault), Status::Code::hardware_failure};
  }
  switch (state_of(tick)) {
    case device::State::active:
      return {"feeling", "Feeling: forces are on", Status::Code::ok};
    case device::State::ramping:
      return {"feeling", "Feeling: forces are coming up or going down", Status::Code::ok};
    case device::State::homing:
      return {"ready", "Ready: homing, move the stylus as its maker says"};
    case device::State::idle:
      return {"ready", "Ready: no force"};
    default:
      return {"off", "Off: the stylus does not answer"};
  }
}

Announcer::Announcer(const LiveSession& session, Server& server, Publisher& publisher, const Received& received,
                     JobThreads& threads, MakesMarks makes_marks)
    : session_(session),
      server_(server),
      publisher_(publisher),
      received_(received),
      makes_marks_(makes_marks),
      shapes_(threads) {
  follow_session();
  announce_marks();
}

void Announcer::offer(const char* type, const std::string& device, Bytes content, double stamp, bool kept) {
  Bytes wire;
  append(wire, {.type = type, .device = device, .time_s = stamp, .content = std::move(content)});
  server_.offer(std::string(type) + " " + device, std::move(wire), kept);
}

/// Every connection of a stylus, and every recording, restarts the session.
void Announcer::follow_session() {
  auto ticks = session_.is_connected() ? session_.shared_ticks() : nullptr;
  if (ticks != ticks_) {
    ticks_ = std::move(ticks);
    publisher_.set_ticks(ticks_);
    if (const auto plan = session_.plan()) workspace_.set(plan->workspace);
    next_tick_ = 0;
    presses_ = {};
    is_cut_off_ = false;
    is_new_ = true;
    next_status_ = {};
  }
  if (!std::exchange(is_new_, false) && plan_ == session_.plan() && scan_ == session_.scan()) return;
  plan_ = session_.plan();
  const auto before = std::exchange(scan_, session_.scan());
  const bool is_same = before == scan_ || (before && scan_ && have_same_space(*before, *scan_));
  if (before && !is_same) leave_marks();
  announce_scene();
}

/// Places in another patient mean nothing here. The owner of marks that are made elsewhere does the same.
void Announcer::leave_marks() {
  if (makes_marks_ == MakesMarks::no) return;
  set_marks({});
  presses_.drop();
  is_cut_off_ = true;
  scan_epoch_ = session_.epoch();
}

void Announcer::announce_scene() {
  if (const auto plan = session_.plan()) {
    publisher_.set_workspace(session_.epoch(), plan->workspace);
    workspace_.change_to(plan->workspace, session_.epoch());
  }
  const std::string scene = modes::to_json(received_.with_names(session_.scene()));
  if (scene.size() <= longest_string) {
    offer("STRING", scene_name, string_content(scene), 0, true);
  } else {  // better none than one that is not felt
    server_.forget(std::string("STRING ") + scene_name);
    tell(say("igtl-scene-too-long", scene.size(), longest_string));
  }
  shapes_wanted_ = Clock::now() + (shapes_sent_.empty() ? std::chrono::milliseconds(0) : tuning);
}

void Announcer::look() {
  follow_session();
  publisher_.set_orientation(session_.orientation());
  follow_marks();
  announce_shapes();
  const auto now = Clock::now();
  if (!ticks_) {
    if (now >= next_status_) announce_off();
    return;
  }
  const std::uint64_t written = ticks_->written();
  TickRecord tick;
  std::vector<PrimitiveRecord> shares;
  if (written == 0 || !ticks_->read(written - 1, tick, &shares)) return;
  const std::string state = state_of_session(tick).state;
  if (state != last_state_ || now >= next_status_) {
    last_state_ = state;
    next_status_ = now + between_status;
    announce_status(tick);
  }
  if (now >= next_contact_) {
    next_contact_ = now + between_contacts;
    announce_contact(tick, shares);
  }
}

void Announcer::announce_off() {
  last_state_ = "off";
  next_status_ = Clock::now() + between_status;
  offer("STATUS", program_name,
        content_of(Status{.code = Status::Code::not_ready, .name = last_state_, .text = "Off: no stylus is connected"}),
        0, true);
}

void Announcer::announce_status(const TickRecord& tick) {
  const StateInWords words = state_of_session(tick);
  const ServerCounts counts = server_.counts();
  const std::string text =
      fmt::format("{}. Clients {}, messages refused {}, passed over {}, replaced {}", words.sentence, counts.clients,
                  counts.refused, counts.passed_over, counts.replaced + counts.outrun);
  offer("STATUS", program_name, content_of(Status{.code = words.code, .name = words.state, .text = text}),
        publisher_.stamp_of(tick), true);
}

void Announcer::announce_contact(const TickRecord& tick, const std::vector<PrimitiveRecord>& shares) {
  const modes::Scene& scene = session_.scene();
  nlohmann::ordered_json contact{{"tick", tick.index}, {"time_s", tick.time_s}, {"state", last_state_}};
  contact["value"] = number_or_null(tick.value);
  contact["unit"] = session_.scan()->unit;
  contact["tissue"] = tissue_name(scene, session_.scan()->unit, tick.value);
  contact["force_n"] = glm::length(vector_of(tick.sent_n));
  contact["boundary"] = nullptr;
  if (tick.scene_epoch == session_.epoch() && tick.change_part >= 1) {
    const modes::Workspace& workspace = session_.plan()->workspace;
    const auto held = held_boundary(shares, session_.felt(), scene, workspace.to_patient(vector_of(tick.proxy_m)),
                                    workspace.to_patient(vector_of(tick.probe_m)));
    if (held) {
      const modes::Mode& mode = scene.modes[held->mode];
      contact["boundary"] = mode.name.empty() ? mode.type : mode.name;
      contact["known_to_mm"] = held->known_to_mm ? number_or_null(*held->known_to_mm) : nlohmann::ordered_json();
      contact["in_words"] = in_words(*held);
    }
  }
  if (tick.scene_epoch == session_.epoch()) {
    auto& distances = contact["distances_mm"] = nlohmann::ordered_json::object();
    for (std::size_t n = 0; n < session_.plan()->structures.size() && n < distance_count; ++n) {
      distances[scene.structures[session_.plan()->structures[n]].name] = number_or_null(tick.distance_mm[n]);
    }
  }
  const std::string text = contact.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() <= longest_string) {
    offer("STRING", contact_name, string_content(text), publisher_.stamp_of(tick), false);
  }
}

void Announcer::set_marks(const std::vector<Point>& marks) {
  // As with scenes: data that a client only sends back are no change.
  constexpr double same_mm = 1e-3;
  const auto same = [](const Point& a, const Point& b) {
    return a.name == b.name && glm::distance(a.position, b.position) < same_mm;
  };
  if (std::ranges::equal(marks, marks_, same)) return;
  marks_ = marks;
  announce_marks();
}

void Announcer::announce_marks() {
  offer("POINT", marks_name, content_of(marks_), 0, true);
}

void Announcer::merge_marks(const std::vector<Point>& sent) {
  follow_session();  // they are for the present scan
  std::vector<Point> marks = marks_;
  for (const ChangedMark& changed : changed_marks(marks_, sent)) {
    (changed.at < marks.size() ? marks[changed.at] : marks.emplace_back()) = changed.mark;
  }
  set_marks(marks);
}

std::string Announcer::free_name() const {
  Marks all;
  for (const Point& mark : marks_) all.points.push_back({.name = mark.name});
  return free_mark_name(all);
}

void Announcer::follow_marks() {
  if (!ticks_ || makes_marks_ == MakesMarks::no) return;
  TickRecord tick;
  std::vector<PrimitiveRecord> shares;
  for (next_tick_ = std::max(next_tick_, ticks_->oldest()); next_tick_ < ticks_->written(); ++next_tick_) {
    shares.clear();
    if (!ticks_->read(next_tick_, tick, &shares)) continue;
    const modes::Workspace workspace = workspace_.at(tick);
    const bool is_pressed = (tick.buttons & mark_button) != 0;
    is_cut_off_ = is_cut_off_ && (is_pressed || tick.scene_epoch < scan_epoch_);
    if (is_cut_off_ || (!is_pressed && !presses_.is_down())) continue;
    const glm::dvec3 proxy = workspace.to_patient(vector_of(tick.proxy_m));
    // Their modes are those of the scene of the tick.
    if (tick.scene_epoch != session_.epoch()) shares.clear();
    const auto made = presses_.take(
        {.tick = tick, .time_s = tick.time_s, .proxy_mm = proxy, .shares = shares, .scene = session_.scene()});
    const auto* const mark = made ? std::get_if<FeltMark>(&*made) : nullptr;
    if (mark == nullptr) continue;
    marks_.push_back({.name = free_name(),
                      .group = mark->boundary,
                      .position = ras_of(mark->position_mm),
                      .diameter = mark_diameter_mm,
                      .owner = program_name});
    announce_marks();
  }
}

void Announcer::announce_shapes() {
  if (shapes_.is_busy()) {
    if (!shapes_.is_ready()) return;
    std::map<std::string, std::size_t> sent;
    for (Shape& shape : shapes_.take()) {
      const std::string name = shape.type + " " + shape.name;
      const std::string_view bytes(reinterpret_cast<const char*>(shape.content.data()), shape.content.size());
      const std::size_t hash = sent[name] = std::hash<std::string_view>()(bytes);
      const auto before = shapes_sent_.find(name);
      if (before != shapes_sent_.end() && before->second == hash) continue;  // clients have it
      offer(shape.type.c_str(), shape.name, std::move(shape.content), 0, true);
    }
    for (const auto& [name, hash] : shapes_sent_) {
      if (!sent.contains(name)) server_.forget(name);
    }
    shapes_sent_ = std::move(sent);
  }
  if (!shapes_wanted_ || Clock::now() < *shapes_wanted_) return;
  shapes_wanted_.reset();
  shapes_.start([felt = session_.felt(), scene = session_.scene()](const io::Progress& progress) {
    return shapes_of(felt, scene, progress);
  });
}

}  // namespace palpate::plugin::igtl
