// The session for the tests with the real libraries: opens a device as palpate does, pushes, and ends.
//   device_client KIND SCENARIO [FILE]
// KIND: falcon (FILE: firmware), wooden_haptics (FILE: settings), space_mouse, haply, touch, force_dimension.
// SCENARIO: run | unplug | replug | replug_close | sigint | sigterm | sigkill | sigstop | denied, or push: until it is
// ended by a signal.

#include <pthread.h>
#include <sched.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/device_type.h"
#include "device/falcon/falcon.h"
#include "device/found_devices.h"
#include "device/link/link_stylus.h"
#include "device/link/realtime.h"
#include "device/space_mouse/space_mouse.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace {

using namespace palpate::device;

constexpr int servo_priority = 50;  // below the thread that drives the device

struct Run {
  int fresh = 0;
  double seconds = 0;
};

/// Ticks at 1 kHz until the time is over or the state is the one waited for.
Run tick(Stylus& stylus, const Vec3& force, double seconds, State until) {
  Metronome metronome(1e-3);
  Run run;
  const double start = monotonic_time();
  while ((run.seconds = monotonic_time() - start) < seconds && stylus.state() != until) {
    run.fresh += stylus.read().fresh ? 1 : 0;
    stylus.write_force(force);
    metronome.wait();
  }
  return run;
}

/// Pushes upwards for this long. If a busy machine delays the session, its driver takes that for a fault; a session
/// that must push until its end is then opened again.
Run push(Stylus& stylus, double seconds, int sessions) {
  for (;;) {
    const Run run = tick(stylus, Vec3(0, 1, 0), seconds, State::fault);
    if (stylus.state() != State::fault || --sessions == 0) return run;
    stylus.close();
    stylus.open();
    tick(stylus, Vec3(0), 10, State::idle);
  }
}

/// The one device that there is.
FoundDevice find_it() {
  const std::vector<FoundDevice> found = find_devices();
  for (const FoundDevice& device : found) {
    std::printf("client: found %s '%s' at %s%s\n", device.kind.c_str(), device.name.c_str(), device.address.c_str(),
                device.accessible ? "" : " (not accessible)");
  }
  if (found.size() != 1) throw std::runtime_error(std::to_string(found.size()) + " devices were found, not one");
  return found.front();
}

/// As the panel does, and the guardian: as urgently as any program, so that the kernel's threads of the bus go on. A
/// search opens each node and lets go of it.
std::size_t search_calmly() {
  const sched_param any{};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &any);
  const std::size_t found = find_devices().size();
  make_thread_realtime(servo_priority);
  return found;
}

int expect(bool holds, const char* what) {
  if (!holds) std::printf("client: failed: %s\n", what);
  return holds ? 0 : 1;
}

int play(Stylus& stylus, const std::string& scenario) {
  int failures = expect(find_it().accessible, "found, and may be opened");
  stylus.open();
  tick(stylus, Vec3(0), 10, State::idle);
  failures += expect(stylus.state() == State::idle, "homed within 10 s");
  failures += expect(search_calmly() == 1, "found while it is held, which its holder does not notice");
  constexpr double pushing = 1;  // s: the ramp after a delay lasts a quarter of it
  if (scenario == "push") {
    const Run held = push(stylus, 60, 20);
    std::printf("client: nobody ended it in %.1f s, state %s\n", held.seconds, name_of(stylus.state()));
    return 1;
  }
  const Run run = push(stylus, pushing, scenario.starts_with("sig") ? 5 : 1);
  std::printf("client: %d new poses in %.2f s, state %s\n", run.fresh, run.seconds, name_of(stylus.state()));
  std::fflush(stdout);
  const bool is_replugged = scenario.starts_with("replug");
  if (scenario == "unplug" || is_replugged) {
    tick(stylus, Vec3(0, 1, 0), 10, State::fault);
    failures += expect(stylus.state() == State::fault, "unplugged is a fault");
    if (const auto* link = dynamic_cast<const LinkStylus*>(&stylus)) {
      std::printf("client: %s: %s\n", name_of(link->fault()), link->trouble().c_str());
    }
  } else {
    failures += expect(run.fresh > 40 * pushing, "more than 40 poses a second, also on a busy machine");
    failures += expect(stylus.state() == State::idle, "still there");
  }
  std::fflush(stdout);
  if (failures > 0) return failures;
  if (scenario == "replug") tick(stylus, Vec3(0, 1, 0), 4, State::disconnected);
  if (scenario == "sigint") std::raise(SIGINT);
  if (scenario == "sigterm") std::raise(SIGTERM);
  if (scenario == "sigkill") std::raise(SIGKILL);
  if (scenario == "sigstop") std::raise(SIGSTOP);
  if (stylus.specification().force_axes == 0) {
    failures += expect(stylus.read().position.x > 0.05, "a puck that is pushed for a second moves");
  }
  stylus.close();
  return failures;
}

/// A user without permission is told which commands to type.
int be_denied(Stylus& stylus) {
  const FoundDevice device = find_it();
  int failures = expect(!device.accessible, "may not be opened");
  failures += expect(device.note == permission_advice(), "the list says what to type");
  try {
    stylus.open();
    failures += expect(false, "opening is refused");
  } catch (const std::exception& error) {
    const std::string what = error.what();
    failures += expect(what.find("permission denied; " + permission_advice()) != std::string::npos, error.what());
  }
  return failures + expect(stylus.state() == State::disconnected, "stays closed");
}

int play(std::unique_ptr<Stylus> stylus, const std::string& scenario) {
  return scenario == "denied" ? be_denied(*stylus) : play(*stylus, scenario);
}

}  // namespace

int main(int count, char** arguments) {
  const std::string kind = count > 1 ? arguments[1] : "";
  const std::string scenario = count > 2 ? arguments[2] : "";
  make_thread_realtime(servo_priority);
  try {
    if (kind == "falcon") {
      FalconSettings settings;
      settings.firmware_file = count > 3 ? arguments[3] : "";
      return play(make_falcon(settings), scenario);
    }
    if (kind == "wooden_haptics" && count > 3) {
      return play(make_wooden_haptics(read_wooden_haptics(arguments[3])), scenario);
    }
    if (kind == "space_mouse") return play(make_space_mouse(), scenario);
    if (const DeviceType* const type = find_device_type(kind)) return play(*type->make({}), scenario);
  } catch (const std::exception& error) {
    std::printf("client: refused: %s\n", error.what());
    return 1;
  }
  std::puts("device_client KIND SCENARIO [FILE]");
  return 2;
}
