#include "device/testing/fake_rigs.h"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "device/falcon/falcon_driver.h"
#include "device/force_dimension/force_dimension_driver.h"
#include "device/haply/haply_driver.h"
#include "device/simulated/simulated_stylus.h"
#include "device/space_mouse/space_mouse_driver.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/fake_haply.h"
#include "device/testing/fake_libdrd.h"
#include "device/testing/fake_libhd.h"
#include "device/testing/fake_space_mouse.h"
#include "device/testing/fake_wooden_haptics.h"
#include "device/touch/touch_driver.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {

namespace {

constexpr double homing_time = 1.0;  // s

double asleep_s = 0;
double asleep() noexcept {
  return asleep_s;
}

/// The guardian that the next rig's stylus will start.
std::shared_ptr<FakeGuardian> next_guard;

LinkStylusOptions in_this_thread(bool guarded = true) {
  LinkStylusOptions options;
  options.threaded = false;
  options.asleep = &asleep;
  options.guardian_patience = 0;
  options.start_guardian = [guard = next_guard, guarded](const GuardianSettings&) {
    return guarded ? guard->start() : nullptr;
  };
  return options;
}

std::vector<Waypoint> after_homing(std::vector<Waypoint> begin, const std::vector<Waypoint>& path) {
  for (Waypoint point : path) {
    point.time += homing_time;
    begin.push_back(point);
  }
  return begin;
}

FakeRig falcon(const std::vector<Waypoint>& path) {
  FakeFalconOptions options;
  options.path = after_homing({{0.05, {0, 0, 0}}, {0.30, {0, 0, 0.039}}, {0.60, {0, 0, 0}}}, path);
  auto bench = std::make_shared<FakeFalconBench>(options);
  std::shared_ptr<LinkStylus> stylus = make_falcon_on(
      {}, [bench] { return std::make_unique<FakeFalconLink>(*bench); }, in_this_thread());
  FakeFalconFaults* const faults = &bench->falcon.faults;
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = [bench] { return bench->time; };
  rig.exchange = [stylus] { stylus->service(0.2e-3); };
  rig.pass = [bench](double seconds) { bench->time += seconds; };
  // It holds its last command for ever: whether a real one has a watchdog is unknown.
  rig.force = [bench] { return bench->falcon.force(); };
  rig.fling = [bench](const Vec3& velocity) { bench->falcon.hand().fling(velocity); };
  rig.guardian = [bench] {
    FakeFalconLink link(*bench);
    zero_falcon(link);
  };
  rig.unplug = [bench] {
    bench->unplugged = true;
    bench->falcon.lose_usb();
  };
  rig.replug = [bench] { bench->unplugged = false; };
  rig.silence = [faults] { faults->silent = true; };
  rig.shorten = [faults] { faults->most_payload = 3; };
  rig.garble = [faults] { faults->garble_every = 2; };
  rig.impossible = [faults] { faults->impossible_pose = true; };
  rig.delay = [faults](double delay) { faults->reply_delay = delay; };
  rig.unhome = [faults] { faults->home_lost = true; };
  return rig;
}

FakeRig wooden_haptics(const std::vector<Waypoint>& path) {
  auto bench = std::make_shared<FakeHidBench>();
  FakeWoodenHapticsOptions options;
  options.path = after_homing({{0, Vec3(0)}}, path);
  auto arm = std::make_shared<FakeWoodenHaptics>(options);
  std::shared_ptr<LinkStylus> stylus = make_wooden_haptics_on(
      options.arm, [arm, bench] { return std::make_unique<FakeHidLink>(*arm, *bench); }, in_this_thread());
  FakeWoodenHapticsFaults* const faults = &arm->faults;
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = [bench] { return bench->time; };
  rig.exchange = [stylus] { stylus->service(0.2e-3); };
  rig.pass = [bench](double seconds) { bench->time += seconds; };
  rig.force = [arm, bench] { return arm->is_pushing(bench->time) ? arm->force() : Vec3(0); };
  rig.fling = [arm](const Vec3& velocity) { arm->hand().fling(velocity); };
  rig.guardian = [arm, bench] { arm->write(std::array<std::uint8_t, 14>{}, bench->time); };
  rig.unplug = [bench] { bench->unplugged = true; };
  rig.replug = [bench] { bench->unplugged = false; };
  rig.silence = [faults] { faults->silent = true; };
  rig.shorten = [faults] { faults->short_every = 10; };
  rig.garble = [faults] { faults->garble_every = 2; };
  rig.impossible = [faults] { faults->impossible_pose = true; };
  rig.delay = [faults](double delay) { faults->report_delay = delay; };
  rig.unhome = [faults] { faults->button_pressed = true; };
  return rig;
}

FakeRig space_mouse(const std::vector<Waypoint>& /*path*/) {
  auto bench = std::make_shared<FakeHidBench>();
  auto puck = std::make_shared<FakeSpaceMouse>(true);
  puck->deflect(Vec3(0, 0, 100));  // down, slowly
  std::shared_ptr<LinkStylus> stylus = make_space_mouse_on(
      {}, [puck, bench] { return std::make_unique<FakeHidLink>(*puck, *bench); }, in_this_thread(false));
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = [bench] { return bench->time; };
  rig.exchange = [stylus] { stylus->service(0.2e-3); };
  rig.pass = [bench](double seconds) { bench->time += seconds; };
  rig.force = [] { return Vec3(0); };  // it has no motors
  rig.unplug = [bench] { bench->unplugged = true; };
  return rig;
}

FakeRig simulated(const std::vector<Waypoint>& path) {
  auto stylus = std::make_shared<SimulatedStylus>();
  stylus->follow(after_homing({{0, Vec3(0)}}, path));
  auto time = std::make_shared<double>(0);
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = [time] { return *time; };
  rig.exchange = [time] { *time += 1e-3; };
  rig.pass = [time](double seconds) { *time += seconds; };
  rig.force = [stylus] { return stylus->acting_force(); };
  rig.unplug = [stylus] { stylus->inject(SimulatedFault::unplugged); };
  rig.silence = [stylus] { stylus->inject(SimulatedFault::stalled); };
  rig.impossible = [stylus] { stylus->inject(SimulatedFault::not_a_number); };
  return rig;
}

/// A hand on a device whose fake has none of its own, stepped by the force on it.
struct Held {
  explicit Held(const std::vector<Waypoint>& path)
      : hand({.mass = 0.1, .half_extent = Vec3(0.06)}, {}, after_homing({{0, Vec3(0)}}, path)) {}
  FakeHand hand;
  bool is_elsewhere = false;  ///< where no arm reaches
  Vec3 place() const { return is_elsewhere ? Vec3(5, 0, 0) : hand.body().position; }
};

FakeRig haply(const std::vector<Waypoint>& path, const char* type) {
  auto service = std::make_shared<FakeHaply>();
  service->type = type;
  service->delay = 0.8e-3;  // an exchange in a millisecond, as over a socket
  auto held = std::make_shared<Held>(path);
  std::shared_ptr<LinkStylus> stylus = make_haply_on(
      {}, [service] { return std::make_unique<FakeHaplyLink>(*service); }, in_this_thread());
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = [service] { return service->time; };
  // Theirs: x right, y away from the user, z up.
  rig.force = [service] {
    const Vec3 theirs = service->acting(service->time);
    return Vec3(theirs.x, theirs.z, -theirs.y);
  };
  const auto follow = [service, held, force = rig.force] {
    held->hand.advance(service->time, force());
    const Vec3 place = held->place();
    service->place = {place.x, -place.z, place.y};
  };
  rig.exchange = [stylus, follow] {
    follow();
    stylus->service(0.2e-3);
  };
  rig.pass = [service, follow](double seconds) {
    service->time += seconds;
    follow();
  };
  rig.fling = [held](const Vec3& velocity) { held->hand.fling(velocity); };
  rig.guardian = [] {};
  rig.guardian_looks_on = true;  // forces of several sessions add up
  rig.torques = [service] { return service->torques; };
  rig.unplug = [service] { service->gone = true; };
  rig.silence = [service] { service->silent = true; };
  rig.halve = [service] { service->halves = true; };
  rig.garble = [service] { service->garbles_every = 2; };
  rig.impossible = [held] { held->is_elsewhere = true; };
  rig.delay = [service](double delay) { service->delay = delay; };
  rig.foreign = [service] { service->others_force = Vec3(0, 0, 1.5); };
  rig.unhome = [service] { service->calibrated = false; };
  return rig;
}

/// For the fake libraries, of which a process has only one: each rig restarts its clock.
double library_time = 0;
double library_now() noexcept {
  return library_time;
}
/// Of a driver that waits for callbacks, which come by hand: its patience has to end all the same.
double impatient_now() noexcept {
  return library_time += 0.1e-3;
}
void library_sleep(double seconds) noexcept {
  library_time += seconds;
}

/// Of a driver whose library calls back, a thousand times a second.
void (*library_round)() = nullptr;
void sleep_in_rounds(double seconds) noexcept {
  for (double passed = 0; passed < seconds; passed += 1e-3) {
    library_time += 1e-3;
    library_round();
  }
}

template <typename Function>
Function function_of(const char* file, const char* name) {
  void* const library = dlopen(file, RTLD_NOW | RTLD_NODELETE);
  void* const function = library == nullptr ? nullptr : dlsym(library, name);
  if (function == nullptr) throw std::runtime_error(std::string(file) + ": no " + name);
  return reinterpret_cast<Function>(function);
}

FakeRig touch(const std::vector<Waypoint>& path) {
  const char* const file = PALPATE_FAKE_LIBHD;
  setenv("PALPATE_LIBHD", file, 1);
  FakeHd* const hd = function_of<FakeHd* (*)()>(file, "fake_hd")();
  *hd = {};
  const auto call = function_of<void (*)()>(file, "fake_hd_call");
  const auto by_hand = function_of<void (*)(bool)>(file, "fake_hd_by_hand");
  by_hand(true);
  library_time = 0;
  library_round = call;
  const std::shared_ptr<void> by_itself(nullptr, [by_hand](void*) { by_hand(false); });
  std::shared_ptr<LinkStylus> stylus = make_touch_with({}, in_this_thread(), {&impatient_now, &sleep_in_rounds});
  auto held = std::make_shared<Held>(path);
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = library_now;
  rig.force = [hd, by_itself] { return Vec3(hd->force[0], hd->force[1], hd->force[2]); };
  const auto follow = [hd, held, force = rig.force] {
    held->hand.advance(library_time, force());
    for (int i = 0; i < 3; ++i) hd->place_mm[i] = 1e3 * held->place()[i];
  };
  rig.exchange = [stylus, call, follow] {
    library_time += 1e-3;
    follow();
    call();
    stylus->service(0);
  };
  rig.pass = [follow](double seconds) {
    library_time += seconds;
    follow();
  };
  rig.fling = [held](const Vec3& velocity) { held->hand.fling(velocity); };
  // The library of another process: its forces replace those of the stopped process.
  rig.guardian = [hd] { hd->force[0] = hd->force[1] = hd->force[2] = 0; };
  rig.torques = [hd] { return hd->torques; };
  rig.unplug = [hd] { hd->unplugged = 1; };
  rig.replug = [hd] { hd->unplugged = 0; };
  rig.silence = [hd] { hd->stalled = 1; };
  rig.impossible = [held] { held->is_elsewhere = true; };
  rig.unhome = [hd] { hd->calibration = 0x5002; };
  return rig;
}

FakeRig force_dimension(const std::vector<Waypoint>& path) {
  const char* const file = PALPATE_FAKE_LIBDRD;
  setenv("PALPATE_LIBDRD", file, 1);
  FakeDrd* const drd = function_of<FakeDrd* (*)()>(file, "fake_drd")();
  *drd = {};
  const auto pushes = function_of<bool (*)()>(file, "fake_drd_is_pushing");
  const auto set_clock = function_of<void (*)(double (*)())>(file, "fake_drd_set_clock");
  set_clock([] { return library_time; });
  library_time = 0;
  const std::shared_ptr<void> own_clock(nullptr, [set_clock](void*) { set_clock(nullptr); });
  std::shared_ptr<LinkStylus> stylus = make_force_dimension_with({}, in_this_thread(), {&library_now, &library_sleep});
  auto held = std::make_shared<Held>(path);
  FakeRig rig;
  rig.stylus = stylus;
  rig.now = library_now;
  // Theirs: x towards the user, y right, z up.
  rig.force = [drd, pushes, own_clock] {
    return pushes() ? Vec3(drd->force[1], drd->force[2], drd->force[0]) : Vec3(0);
  };
  const auto follow = [drd, held, force = rig.force] {
    held->hand.advance(library_time, force());
    const Vec3 place = held->place();
    drd->place[0] = place.z, drd->place[1] = place.x, drd->place[2] = place.y;
  };
  rig.exchange = [stylus, follow] {
    follow();
    stylus->service(1e-3);
  };
  rig.pass = [follow](double seconds) {
    library_time += seconds;
    follow();
  };
  rig.fling = [held](const Vec3& velocity) { held->hand.fling(velocity); };
  rig.guardian = [drd] { drd->forces_on = 0; };
  rig.torques = [drd] { return drd->torques; };
  rig.unplug = [drd] { drd->unplugged = 1; };
  rig.replug = [drd] { drd->unplugged = 0; };
  rig.impossible = [held] { held->is_elsewhere = true; };
  // Its poses fail, its forces do not; and it is a model without a watchdog.
  rig.silence = [drd] {
    drd->watchdog_s = 0;
    std::strcpy(drd->failing_call, "dhdGetPosition");
  };
  rig.unhome = [drd] { drd->homed = 0; };
  rig.refuse = [drd] { std::strcpy(drd->failing_call, "dhdSetForceAndTorqueAndGripperForce"); };
  return rig;
}

}  // namespace

std::unique_ptr<Guardian> FakeGuardian::start() {
  beat.count = 0;
  beat.on_device = OnDevice::zero_taken;
  beat.sleep_is_near = false;
  beat.proof = proves ? proof_for(beat.challenge) : 0;
  beat.reach = GuardianReach::at_any_time;
  return std::make_unique<Guardian>(0, -1, &beat);
}

void put_rigs_to_sleep(double seconds) {
  asleep_s += seconds;
}

std::span<const char* const> rig_kinds() {
  static constexpr std::array kinds{"simulated", "falcon",   "wooden_haptics", "space_mouse",
                                    "haply",     "minverse", "touch",          "force_dimension"};
  return kinds;
}

std::string name_of_rig(const std::string& kind) {
  if (kind == "haply") return "Haply Inverse3";
  if (kind == "minverse") return "Haply Minverse";
  if (kind == "force_dimension") return "Force Dimension";
  return std::string(find_device_type(kind)->name);
}

FakeRig make_rig(const std::string& kind, const std::vector<Waypoint>& path) {
  const auto make = [&]() -> FakeRig {
    if (kind == "simulated") return simulated(path);
    if (kind == "falcon") return falcon(path);
    if (kind == "wooden_haptics") return wooden_haptics(path);
    if (kind == "space_mouse") return space_mouse(path);
    if (kind == "haply") return haply(path, "inverse3");
    if (kind == "minverse") return haply(path, "minverse");
    if (kind == "touch") return touch(path);
    if (kind == "force_dimension") return force_dimension(path);
    throw std::runtime_error("there is no rig " + kind);
  };
  next_guard = std::make_shared<FakeGuardian>();
  FakeRig rig = make();
  if (rig.guardian) {
    rig.guard = next_guard;
    rig.exchange = [guard = next_guard, exchange = rig.exchange] {
      if (guard->lives) ++guard->beat.lives;
      exchange();
    };
    rig.pass = [guard = next_guard, pass = rig.pass](double seconds) {
      if (guard->lives) ++guard->beat.lives;
      pass(seconds);
    };
  }
  rig.type = find_device_type(kind == "minverse" ? "haply" : kind);
  return rig;
}

}  // namespace palpate::device
