#include "device/testing/fault_table.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "device/safety/safety_filter.h"
#include "device/testing/fake_rigs.h"

namespace palpate::device {

namespace {

constexpr double tick_s = 1e-3;
constexpr double never = std::numeric_limits<double>::infinity();
/// The guardian looks every 20 ms and acts after ten looks without a sign of life; then it has to open the device.
constexpr double guardian_s = 0.24;
constexpr double guardian_opens_s = 0.02;  // after the end of its pipe

/// A session at 1 kHz of the rig's own time: reads, filters, writes.
class FaultSession {
 public:
  explicit FaultSession(const std::string& kind) : rig(make_rig(kind)) {
    rig.stylus->open();
    run(1.1);
    arm(state);
    run(0.7);
    if (rig.type->has_force && (result.state != State::active || rig.force() == Vec3(0))) {
      throw std::logic_error(kind + ": its fake does not push before the event");
    }
    row.before_n = glm::length(rig.force());
    begin();
  }

  FakeRig rig;
  SafetyLimits limits;
  SafetyState state;
  SafetyResult result;
  FaultRow row;
  Vec3 asked{0, 2.5, 0};
  bool program_lives = true, servo_runs = true, scene_runs = true, commander_lives = true;

  /// Measurements start here.
  void begin() {
    begun_ = true;
    started_ = rig.now();
    pushed_until_ = row.largest_after_n = row.largest_step_n = 0;
    last_force_ = rig.force();
  }
  void run(double seconds) {
    for (const double end = rig.now() + seconds; rig.now() < end;) {
      const double before = rig.now();
      program_lives ? rig.exchange() : rig.pass(tick_s);
      if (rig.now() == before) rig.pass(tick_s);  // one that is closed takes no time
      if (program_lives && servo_runs && rig.now() >= next_tick_) tick();
      observe();
    }
  }
  /// The program is stopped; after `zeroed` s its guardian acts.
  void stand_still(double seconds, double zeroed) {
    bool acted = false;
    for (double passed = 0; passed < seconds; passed += tick_s) {
      if (!acted && passed >= zeroed && rig.guardian) {
        rig.guardian();
        acted = true;
      }
      rig.pass(tick_s);
      observe();
    }
  }
  /// Opened again with an invalid guardian: no force is ever given.
  bool is_refused() {
    rig.stylus->close();
    rig.guard->proves = false;
    begin();
    try {
      rig.stylus->open();
    } catch (const std::exception&) {
      return true;
    }
    throw std::logic_error("a guardian that proves nothing is taken for one");
  }
  FaultRow finish() {
    row.left_n = glm::length(rig.force());
    row.torques = rig.torques();
    if (row.left_n == 0) row.zero_taken_s = pushed_until_;
    return row;
  }

 private:
  void tick() {
    next_tick_ = rig.now() + tick_s - 1e-9;
    SafetyInput input{.time = rig.now(), .reading = rig.stylus->read(), .device = rig.stylus->state()};
    // A hand that goes on into a wall after a fault, somewhere else.
    input.force = result.fault != Fault::none ? Vec3(4, 0, -4) : asked;
    input.force_time = scene_time_ = scene_runs ? input.time : scene_time_;
    input.heartbeat_time = commander_time_ = commander_lives ? input.time : commander_time_;
    result = filter_force(limits, input, state);
    rig.stylus->write_force(result.force);
  }
  void observe() {
    const Vec3 force = rig.force();
    if (begun_ && force != Vec3(0)) {
      pushed_until_ = rig.now() - started_;
      row.largest_after_n = std::max(row.largest_after_n, glm::length(force));
      row.largest_step_n = std::max(row.largest_step_n, glm::length(force - last_force_));
    }
    last_force_ = force;
  }

  bool begun_ = false;
  double next_tick_ = 0, started_ = 0, pushed_until_ = 0, scene_time_ = 0, commander_time_ = 0;
  Vec3 last_force_{0};
};

struct FaultEvent {
  const char* name;
  EndedBy ended_by;
  double seen_after_s;
  double observed_s;
  std::function<bool(FaultSession&)> cause;  ///< false if this device cannot have it
  const char* borne_by = "";                 ///< the kind to which it does nothing
  const char* heard_by = "";                 ///< the kind that takes the program's zeros all the same
};

bool apply(const std::function<void()>& fault) {
  if (fault) fault();
  return static_cast<bool>(fault);
}

bool apply_delay(FaultSession& session, double seconds) {
  if (session.rig.delay) session.rig.delay(seconds);
  return static_cast<bool>(session.rig.delay);
}

FaultEvent late_servo(const char* name, double seconds, EndedBy ended_by) {
  return {name, ended_by, seconds, 1, [seconds](FaultSession& s) {
            s.servo_runs = false;
            s.run(seconds);
            return s.servo_runs = true;
          }};
}

void ask_for_anything(FaultSession& session) {
  session.limits = {.force = 1e9, .device_force = 1e9, .slew = 1e12, .ramp_time = 1e-9, .speed = 1e9};
  session.asked = Vec3(0, 1e6, 0);
}

std::vector<FaultEvent> fault_events() {
  using S = FaultSession;
  return {
      {"killed", EndedBy::guardian, 0, 0.2,
       [](S& s) {
         s.program_lives = false;
         s.stand_still(0.8, guardian_opens_s);
         return !s.rig.is_arithmetic();
       }},
      {"stopped (Ctrl-Z, a debugger)", EndedBy::guardian, 0, 0.5,
       [](S& s) {
         s.stand_still(2, guardian_s);
         return !s.rig.is_arithmetic();
       }},
      {"stopped, and no guardian", EndedBy::device, 0, 0.5,
       [](S& s) {
         s.stand_still(2, never);
         return !s.rig.is_arithmetic();
       }},
      {"servo thread hangs", EndedBy::program, 0, 0.5,
       [](S& s) {
         s.servo_runs = false;
         return !s.rig.is_arithmetic();  // which has no time but the servo's
       }},
      {"scene's forces stop", EndedBy::program, 0, 0.5, [](S& s) { return !(s.scene_runs = false); }},
      {"panel hangs", EndedBy::program, ceiling::heartbeat_s, 3, [](S& s) { return !(s.commander_lives = false); }},
      {"machine sleeps 30 s", EndedBy::program, 0, 0.5,
       [](S& s) {
         put_rigs_to_sleep(30);
         return !s.rig.is_arithmetic();
       }},
      {"unplugged in contact", EndedBy::device, 0, 1, [](S& s) { return apply(s.rig.unplug); }},
      {"plugged in again after 1 s", EndedBy::guardian, 0, 1,
       [](S& s) {
         if (!s.rig.replug) return false;
         s.rig.unplug();
         s.run(1);
         s.rig.replug();
         s.begin();
         s.stand_still(0.5, guardian_s);
         return true;
       }},
      {"plugged in again after 61 s", EndedBy::guardian, 0, 1,
       [](S& s) {
         if (!s.rig.replug) return false;
         s.rig.unplug();
         s.run(1);
         s.rig.pass(60);
         s.rig.replug();
         s.begin();
         s.stand_still(0.5, guardian_s);
         return true;
       }},
      {"its guardian dies", EndedBy::program, ceiling::guardian_s, 1,
       [](S& s) { return s.rig.guard && !(s.rig.guard->lives = false); }},
      {"its guardian does not show that it works", EndedBy::program, 0, 0.5,
       [](S& s) { return s.rig.guard && s.is_refused(); }},
      {"the machine is about to sleep", EndedBy::program, 0, 0.5,
       [](S& s) { return s.rig.guard && (s.rig.guard->beat.sleep_is_near = true); }},
      {"silent", EndedBy::device, 0.02, 1, [](S& s) { return apply(s.rig.silence); }, "", "force_dimension"},
      {"short or split packets", EndedBy::nobody, 0, 0.5, [](S& s) { return apply(s.rig.shorten); }},
      {"half messages", EndedBy::program, 0.5, 1, [](S& s) { return apply(s.rig.halve); }},
      // Of the Haply's many messages half are enough, and each is whole or nothing.
      {"every second packet garbled", EndedBy::program, 0.5, 1, [](S& s) { return apply(s.rig.garble); }, "haply"},
      {"an impossible pose", EndedBy::program, 0, 0.5, [](S& s) { return apply(s.rig.impossible); }},
      {"answers 1 ms late", EndedBy::nobody, 0, 1.5, [](S& s) { return apply_delay(s, 1e-3); }},
      {"answers 10 ms late", EndedBy::program, 0.5, 1.5, [](S& s) { return apply_delay(s, 0.01); }},
      {"answers 100 ms late", EndedBy::program, 0.15, 1.7, [](S& s) { return apply_delay(s, 0.1); }},
      {"answers 1000 ms late", EndedBy::program, 2, 3.5, [](S& s) { return apply_delay(s, 1); }},
      // Its force adds to ours until that is noticed, and stays.
      {"another program pushes with 1.5 N", EndedBy::device, 0, 1,
       [](S& s) {
         s.row.allowed_n = s.row.before_n + 1.5;
         s.row.allowed_step_n = s.row.before_n;  // ours falls to zero, and the other's stays
         return apply(s.rig.foreign);
       }},
      {"refuses forces", EndedBy::device, 0, 1, [](S& s) { return apply(s.rig.refuse); }},
      {"NaN from the scene", EndedBy::program, 0, 0.5,
       [](S& s) {
         s.asked.x = std::numeric_limits<double>::quiet_NaN();
         return true;
       }},
      late_servo("servo late by 5 ms", 0.005, EndedBy::nobody),
      late_servo("servo late by 20 ms", 0.020, EndedBy::nobody),
      late_servo("servo late by 50 ms", 0.050, EndedBy::nobody),
      late_servo("servo late by 90 ms", 0.090, EndedBy::nobody),
      late_servo("servo late by 200 ms", 0.200, EndedBy::program),
      {"the hand at 3 m/s", EndedBy::program, 0, 0.5,
       [](S& s) {
         if (s.rig.fling) s.rig.fling(Vec3(3, 0, 0));
         return static_cast<bool>(s.rig.fling);
       }},
      {"lost home", EndedBy::program, 0.05, 0.5, [](S& s) { return apply(s.rig.unhome); }},
      {"limits of 1e9 and a force of 1e6 N", EndedBy::nobody, 0, 0.5,
       [](S& s) {
         if (s.rig.is_arithmetic()) return false;  // it has no link, and nobody's hand
         ask_for_anything(s);
         s.row.allowed_n = std::min(s.rig.stylus->specification().maximum_force, ceiling::force_n);
         return true;
       }},
  };
}

}  // namespace

const char* name_of(EndedBy ended_by) {
  switch (ended_by) {
    case EndedBy::nobody:
      return "goes on";
    case EndedBy::program:
      return "program";
    case EndedBy::guardian:
      return "guardian";
    case EndedBy::device:
      return "device";
  }
  return "unknown";
}

std::string missed_goal(const FaultRow& row) {
  char text[160] = "";
  const double within_s = row.ended_by == EndedBy::guardian ? 0.3 : row.seen_after_s + 0.1;
  const bool ends = row.ended_by == EndedBy::program || row.ended_by == EndedBy::guardian;
  if (row.torques > 0) {
    std::snprintf(text, sizeof text, "a torque was asked for");
  } else if (row.largest_after_n > row.allowed_n) {
    std::snprintf(text, sizeof text, "%.3f N follow, where %.3f N are allowed", row.largest_after_n, row.allowed_n);
  } else if (row.largest_step_n > row.allowed_step_n) {
    std::snprintf(text, sizeof text, "a step of %.3f N, where %.3f N are allowed", row.largest_step_n,
                  row.allowed_step_n);
  } else if (ends && !row.zero_taken_s) {
    std::snprintf(text, sizeof text, "the force stays");
  } else if (ends && *row.zero_taken_s > within_s) {
    std::snprintf(text, sizeof text, "a zero after %.3f s, where %.3f s are allowed", *row.zero_taken_s, within_s);
  } else if (row.ended_by == EndedBy::nobody && row.zero_taken_s) {
    std::snprintf(text, sizeof text, "the force is gone, where it goes on");
  }
  return text;
}

std::string brief(const FaultRow& row) {
  char force[24] = "", text[64] = "";
  constexpr double rounding = 1.02;
  if (row.largest_after_n > rounding * row.before_n)
    std::snprintf(force, sizeof force, "%.1f N, ", row.largest_after_n);
  const double zero_s = row.zero_taken_s.value_or(0);
  const bool is_timed = row.ended_by == EndedBy::program || row.ended_by == EndedBy::guardian;
  if (!is_timed) {
    std::snprintf(text, sizeof text, "%s%s", force, name_of(row.ended_by));
  } else {
    const char* const guardian = row.ended_by == EndedBy::guardian ? ", guardian" : "";
    std::snprintf(text, sizeof text, "%s%.2f s%s", force, zero_s, guardian);
  }
  return text;
}

std::string fault_matrix(std::span<const FaultRow> rows) {
  std::vector<std::string> devices, events;
  const auto note = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  };
  for (const FaultRow& row : rows) note(devices, row.device);
  for (const FaultEvent& event : fault_events()) note(events, event.name);
  std::ostringstream text, line;
  text << "| event |";
  line << "|---|";
  for (const std::string& device : devices) {
    text << ' ' << device << " |";
    line << "---|";
  }
  text << '\n' << line.str() << '\n';
  for (const std::string& event : events) {
    text << "| " << event << " |";
    for (const std::string& device : devices) {
      const auto found = std::find_if(rows.begin(), rows.end(),
                                      [&](const FaultRow& row) { return row.device == device && row.event == event; });
      text << ' ' << (found == rows.end() ? std::string() : brief(*found)) << " |";
    }
    text << '\n';
  }
  return text.str();
}

std::vector<FaultRow> fault_table(const std::string& kind) {
  std::vector<FaultRow> rows;
  if (!find_device_type(kind == "minverse" ? "haply" : kind)->has_force) return rows;
  for (const FaultEvent& event : fault_events()) {
    FaultSession session(kind);
    if (!event.cause(session)) continue;
    session.run(event.observed_s);
    FaultRow row = session.finish();
    row.device = name_of_rig(kind);
    row.event = event.name;
    row.ended_by = event.borne_by == session.rig.type->kind   ? EndedBy::nobody
                   : event.heard_by == session.rig.type->kind ? EndedBy::program
                                                              : event.ended_by;
    // A Haply's guardian can only look on: the service adds up the forces of its clients.
    if (row.ended_by == EndedBy::guardian && session.rig.guardian_looks_on) row.ended_by = EndedBy::device;
    row.seen_after_s = event.seen_after_s;
    // Motors and kinematics round; a Falcon's model and its fake's differ by as much.
    row.allowed_n = std::max(row.allowed_n, row.before_n) * 1.02;
    row.allowed_step_n = std::max(row.allowed_step_n, ceiling::slew_n_per_s * ceiling::slew_time_s) * 1.02;
    if (row.ended_by == EndedBy::device) row.zero_taken_s.reset();
    rows.push_back(row);
  }
  return rows;
}

}  // namespace palpate::device
