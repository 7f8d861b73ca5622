#include "device/force_dimension/force_dimension_driver.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "device/falcon/falcon.h"
#include "device/found_devices.h"
#include "device/link/realtime.h"
#include "device/messages.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

constexpr double period = 0.5e-3;  // s between two questions: more would only fill the bus
constexpr int errors_in_a_row = 20;
constexpr int look_at_status_every = 20;

// Of dhdGetStatus().
constexpr std::size_t status_force = 5;
constexpr std::size_t status_error = 9;

// Theirs: x towards the user, y right, z up.
Vec3 to_device_frame(const Vec3& theirs) {
  return {theirs.y, theirs.z, theirs.x};
}
Vec3 to_their_frame(const Vec3& device) {
  return {device.z, device.x, device.y};
}

constexpr int falcon_type_number = 60;

struct Extent {
  int type;
  double half_extent;  // m: of the cube within the maker's cylinder or half-sphere
};
constexpr std::array extents{
    Extent{33, 0.055},  Extent{34, 0.055},  Extent{35, 0.055},  Extent{36, 0.055},  Extent{37, 0.055},
    Extent{63, 0.100},  Extent{206, 0.065}, Extent{104, 0.065}, Extent{105, 0.065}, Extent{203, 0.080},
    Extent{108, 0.080}, Extent{109, 0.080}, Extent{131, 0.080}, Extent{132, 0.080}, Extent{falcon_type_number, 0.040}};

constexpr const char* own_watchdog = "30 ms, in its firmware";
constexpr const char* no_watchdog = "none of its own: without palpate-guardian, switch it off";

// A search opens and closes devices, in a thread of its own. That must not happen to one that is being connected, moves
// to its home, is held or is being disconnected. A search has the mutex as long as it runs. A driver has it only for a
// moment: while an arm moves, a search does not wait, but says that the device is held.
std::mutex searching;
int holders = 0;  // only with the mutex

/// Waits for the end of a search. There is none until the last copy of the result is gone.
std::shared_ptr<void> keep_searches_away() {
  {
    const std::lock_guard lock(searching);
    ++holders;
  }
  return {nullptr, [](void*) {
            const std::lock_guard lock(searching);
            --holders;
          }};
}

double half_extent_of(int type) {
  const auto found = std::find_if(extents.begin(), extents.end(), [&](const Extent& one) { return one.type == type; });
  return found != extents.end() ? found->half_extent : 0.04;
}

}  // namespace

std::string ForceDimensionDriver::last_error() const {
  const char* const text = drd_->error_get_last_str();
  return text != nullptr ? text : "no reason given";
}

void ForceDimensionDriver::choose() {
  const int count = drd_->get_device_count();
  int matching = 0;
  id_ = -1;
  for (int i = 0; i < count; ++i) {
    const int opened = drd_->open(static_cast<char>(i));
    if (opened < 0) continue;
    const bool meant = settings_.address.empty() || settings_.address == drd_->serial_of(static_cast<char>(opened));
    if (meant && ++matching == 1) {
      id_ = static_cast<char>(opened);
    } else {
      drd_->close(static_cast<char>(opened));
    }
  }
  if (matching == 1) return;
  if (matching > 1) {
    drd_->close(std::exchange(id_, char{-1}));
    throw which_of("Force Dimension", static_cast<std::size_t>(matching));
  }
  throw Refusal(
      say("force-dimension-not-found", (settings_.address.empty() ? "" : " " + settings_.address), last_error()));
}

void ForceDimensionDriver::bring_up() {
  const bool has_to_home = !drd_->is_initialized(id_);
  if (has_to_home) {
    if (!settings_.may_home) {
      throw Refusal(say("force-dimension-the-arm-has-no-home"));
    }
    if (drd_->auto_init(id_) < 0) {
      throw Refusal(say("force-dimension-the-arm-did-not-find", last_error()));
    }
  }
  // The regulation that moved the arm ends, and leaves its last force on. Where none ran there is nothing to stop.
  if (drd_->stop(true, id_) < 0 && has_to_home) {
    throw Refusal(say("force-dimension-its-forces-cannot-be-switched", last_error()));
  }
  const auto give_zero = [&] { return drd_->set_force_and_torque_and_gripper_force(0, 0, 0, 0, 0, 0, 0, id_); };
  give_zero();
  // Before a force can act: what takes it away, and how large it may be.
  has_watchdog_ = drd_->set_own_watchdog(id_);
  const double told = drd_->get_max_force(id_);
  const double set = settings_.maximum_force > 0 ? settings_.maximum_force : force_dimension_limits.force_n;
  maximum_force_ = std::min(told > 0 ? told : force_dimension_limits.force_n, set);
  // Whatever the library tells of a Falcon.
  if (drd_->get_system_type(id_) == falcon_type_number) maximum_force_ = std::min(maximum_force_, falcon_force);
  drd_->set_max_force(maximum_force_, id_);
  drd_->set_gravity_compensation(1, id_);
  if (drd_->enable_force(1, id_) < 0 || give_zero() < 0) {
    throw Refusal(say("force-dimension-its-forces-cannot-be-switched", last_error()));
  }
  has_wrist_ = drd_->has_wrist(id_);
}

void ForceDimensionDriver::connect() {
  no_search_ = keep_searches_away();
  const std::uint64_t news = status_.news;
  status_ = {};
  status_.news = news;
  status_.state = State::homing;
  pose_errors_ = asked_ = 0;
  lost_ = false;
  try {
    drd_ = std::make_unique<DrdLibrary>();
    choose();
    bring_up();
  } catch (...) {
    disconnect();
    throw;
  }
  const char* const name = drd_->get_system_name(id_);
  name_ = "Force Dimension " + std::string(name != nullptr ? name : "");
  next_ = now();
}

void ForceDimensionDriver::disconnect() noexcept {
  if (drd_ && id_ >= 0) {
    drd_->dhd_stop(id_);
    drd_->close(id_);
    id_ = -1;
  }
  no_search_.reset();
}

double ForceDimensionDriver::now() noexcept {
  return clock_.now();
}

void ForceDimensionDriver::fail(LinkFault fault) noexcept {
  if (status_.state == State::fault) return;
  status_.state = State::fault;
  status_.fault = fault;
}

void ForceDimensionDriver::take(double timeout) noexcept {
  const double wait = std::min(next_ - now(), timeout);
  if (wait > 0) clock_.sleep(wait);
  next_ = std::max(next_ + period, now());
  Vec3 place;
  const int result = drd_->get_position(&place.x, &place.y, &place.z, id_);
  pose_errors_ = result < 0 ? pose_errors_ + 1 : 0;
  if (pose_errors_ >= errors_in_a_row) lost_ = true;
  if (result < 0 || status_.state == State::fault) return;
  if (!is_finite(place) || glm::length(place) > 1) return fail(LinkFault::unreachable_pose);
  status_.position = to_device_frame(place);
  status_.buttons = drd_->get_button_mask(id_);
  if (has_wrist_) {
    double rows[3][3]{};
    if (drd_->get_orientation_frame(rows, id_) >= 0) {
      // Columns are the stylus' axes; both sides of the rotation change their frame.
      glm::dmat3 turned;
      const std::array theirs{1, 2, 0};  // their axis that is our x, y, z
      for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
          turned[column][row] = rows[theirs[static_cast<std::size_t>(row)]][theirs[static_cast<std::size_t>(column)]];
        }
      }
      status_.orientation = glm::normalize(glm::quat_cast(turned));
    }
  }
  status_.state = State::idle;
  ++status_.news;
  if (++asked_ % look_at_status_every == 0) judge_status();
}

void ForceDimensionDriver::judge_status() noexcept {
  if (!drd_->is_initialized(id_)) return fail(LinkFault::unhomed);
  std::array<int, drd_status_size> told{};
  if (drd_->get_status(told.data(), id_) < 0) return;
  if (told[status_error] != 0 || told[status_force] == 0) fail(LinkFault::own_safety);
}

ForceAnswer ForceDimensionDriver::give(const Vec3& force) noexcept {
  const bool may_push = status_.state == State::idle;
  const Vec3 theirs = may_push ? to_their_frame(clamp_length(force, maximum_force_)) : Vec3(0);
  // 0, 1 (time guard) and 2 (a motor at its limit) are no errors.
  const int result = drd_->set_force_and_torque_and_gripper_force(theirs.x, theirs.y, theirs.z, 0, 0, 0, 0, id_);
  if (result < 0) return ForceAnswer::refused;
  return may_push ? ForceAnswer::taken : ForceAnswer::withheld;
}

void ForceDimensionDriver::describe(Specification& specification) const {
  specification.name = name_;
  specification.orientation_axes = has_wrist_ ? 3 : 0;
  specification.workspace_half_extent = Vec3(half_extent_of(drd_->get_system_type(id_)));
  specification.maximum_force = maximum_force_;
  specification.watchdog = has_watchdog_ ? own_watchdog : no_watchdog;
  specification.continuous_force = maximum_force_;  // the maker's own figure is of a force that lasts
}

std::unique_ptr<LinkStylus> make_force_dimension_with(const ForceDimensionSettings& settings,
                                                      const LinkStylusOptions& options, const DriverClock& clock) {
  check_limits("Force Dimension", settings, force_dimension_limits);
  Specification specification;
  specification.name = "Force Dimension";
  specification.workspace_half_extent = Vec3(0.04);
  specification.position_resolution = 0.01e-3;
  specification.maximum_force = settings.maximum_force > 0 ? settings.maximum_force : force_dimension_limits.force_n;
  specification.continuous_force = specification.maximum_force;
  specification.stiffness_limit = settings.stiffness_limit;
  return std::make_unique<LinkStylus>(specification, std::make_unique<ForceDimensionDriver>(settings, clock), options);
}

std::unique_ptr<Stylus> make_force_dimension(const ForceDimensionSettings& settings) {
  LinkStylusOptions options;
  if (settings.guarded) options.guardian = {guardian_program(), "force_dimension", settings.address};
  options.signs = settings.signs;
  options.stays_awake = true;
  return make_force_dimension_with(settings, options);
}

bool stop_force_dimension(const std::string& address) {
  const DrdLibrary drd;
  int meant = 0, stopped = 0;
  const int count = drd.get_device_count();
  for (int i = 0; i < count; ++i) {
    const int id = drd.open(static_cast<char>(i));
    if (id < 0) {
      if (address.empty()) ++meant;  // it may be the one that pushes
      continue;
    }
    if (address.empty() || address == drd.serial_of(static_cast<char>(id))) {
      ++meant;
      if (drd.dhd_stop(static_cast<char>(id)) >= 0) ++stopped;
    }
    drd.close(static_cast<char>(id));
  }
  return meant > 0 && stopped == meant;
}

std::vector<FoundDevice> find_force_dimension() {
  const std::lock_guard lock(searching);
  std::vector<FoundDevice> found;
  if (holders > 0) return {{"force_dimension", "Force Dimension", "", true, "held by this session"}};
  try {
    const DrdLibrary drd;
    const int count = drd.get_device_count();
    for (int i = 0; i < count; ++i) {
      const int id = drd.open(static_cast<char>(i));
      if (id < 0) continue;
      const char* const name = drd.get_system_name(static_cast<char>(id));
      const bool homed = drd.is_initialized(static_cast<char>(id));
      std::string note = homed ? "" : "it has no home yet: to find it the arm moves by itself";
      if (!drd.set_own_watchdog(static_cast<char>(id))) {
        note += (note.empty() ? "its watchdog: " : "; its watchdog: ") + std::string(no_watchdog);
      }
      found.push_back({"force_dimension", name != nullptr ? name : "Force Dimension",
                       drd.serial_of(static_cast<char>(id)), true, note});
      drd.close(static_cast<char>(id));
    }
  } catch (const std::exception&) {
    return found;
  }
  return found;
}

}  // namespace palpate::device
