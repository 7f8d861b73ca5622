#include "plugin/cli/check_device.h"

#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "device/check/axis_check.h"
#include "device/link/realtime.h"
#include "plugin/app/errors.h"
#include "plugin/app/interruptible.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"

namespace palpate::plugin {

namespace {

using Json = nlohmann::ordered_json;
using device::Felt;

/// The first letter of the answer, in lower case; nothing at the end of input.
std::optional<char> answer_to(const char* question) {
  put("{} ", question);
  std::fflush(stdout);
  std::string line;
  if (!std::getline(std::cin, line) || Interruptible::interrupted()) return {};
  return line.empty() ? '\n' : static_cast<char>(std::tolower(static_cast<unsigned char>(line.front())));
}

bool may_push(const device::AxisPush& push, bool yes) {
  put("\nAxis {}: a push {} with {:.1f} N, as the weight of {:.0f} g, for a second.\n", "xyz"[push.axis],
      device::name_of_direction(push.axis), push.force, push.force / 9.81 * 1000);
  if (yes) return true;
  const auto answer = answer_to("Hold the stylus loosely. Enter pushes, q ends:");
  return answer && *answer != 'q';
}

Felt felt(const device::AxisPush& push, bool yes) {
  put("The stylus says that it moved {:.1f} mm {}{}.\n", 1e3 * std::abs(push.moved), push.moved < 0 ? "against " : "",
      device::name_of_direction(push.axis));
  if (yes) return device::felt_by_pose(push);
  for (;;) {
    const std::string question = std::string("Did it push ") + device::name_of_direction(push.axis) +
                                 "? y: yes, o: the opposite way, n: nothing, q:";
    const auto answer = answer_to(question.c_str());
    if (!answer || *answer == 'q') return Felt::stop;
    if (*answer == 'y') return Felt::as_said;
    if (*answer == 'o') return Felt::opposite;
    if (*answer == 'n') return Felt::nothing;
  }
}

/// Milliseconds of the clock; of a stylus that is arithmetic, as fast as it goes.
std::function<double()> ticks_for(const StylusChoice& choice) {
  if (type_of(choice).is_simulated) {
    return [now = 0.0]() mutable { return now += 1e-3; };
  }
  return [metronome = device::Metronome(1e-3)]() mutable {
    metronome.wait();
    return device::monotonic_time();
  };
}

Json settings_before(const StylusChoice& choice) {
  Json settings = Json::object();
  if (!choice.settings.empty()) {
    std::ifstream stream(choice.settings);
    settings = Json::parse(stream);  // the driver has read it before
  }
  const auto at = choice.device.find('@');
  if (at != std::string::npos) settings["address"] = choice.device.substr(at + 1);
  if (!choice.firmware.empty()) settings["firmware_file"] = choice.firmware;
  return settings;
}

/// The present signs times the ones found.
Json signs(const Json& settings, const char* key, const device::Vec3& found) {
  Json product = settings.contains(key) ? settings.at(key) : Json{1.0, 1.0, 1.0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    product[axis] = product[axis].get<double>() * found[static_cast<int>(axis)];
  }
  return product;
}

void write_settings(const DeviceCheck& check, const std::string& file, const device::AxisCheck& found,
                    const device::Specification& stylus) {
  Json settings = settings_before(check.stylus);
  settings["position_signs"] = signs(settings, "position_signs", found.signs.position);
  settings["force_signs"] = signs(settings, "force_signs", found.signs.force);
  settings["maximum_force"] = stylus.maximum_force;
  settings["stiffness_limit"] = stylus.stiffness_limit;
  std::ofstream stream(file);
  if (!(stream << settings.dump(2) << '\n').flush()) throw InputRefused(say("cannot-be-written", file));
  put("\nWritten: {}. Use it with --device-settings, or name it in the panel.\n", file);
}

void say_result(const device::AxisCheck& found, const device::Stylus& stylus) {
  if (found.fault != device::Fault::none) {
    put("\nThe force was taken away: {}. {}\n", device::name_of(found.fault), device::advice_for(found.fault));
    if (const Text trouble = stylus.trouble(); !trouble.empty()) put("{}\n", trouble);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const char* what = "not felt: nothing was changed; hold the stylus more loosely, or check its power";
    if (found.felt[static_cast<std::size_t>(axis)] == Felt::as_said) what = "as it should be";
    if (found.felt[static_cast<std::size_t>(axis)] == Felt::opposite)
      what = "the force runs the other way: turned round";
    if (found.signs.position[axis] < 0) what = "the position runs the other way: turned round";
    put("Axis {}: {}.\n", "xyz"[axis], what);
  }
}

}  // namespace

void check_device(const DeviceCheck& check) {
  check_device(check, *make_stylus(check.stylus), ticks_for(check.stylus));
}

void check_device(const DeviceCheck& check, device::Stylus& stylus, const std::function<double()>& next_tick) {
  const device::DeviceType& type = type_of(check.stylus);
  const std::string kind(type.kind);
  if (!type.has_force) throw InputRefused(say("stylus-has-no-motors", std::string(type.name)));
  const std::string file = check.output.empty() ? kind + "-settings.json" : check.output;
  const bool writes = type.file != device::DeviceFile::none;
  if (writes && std::filesystem::exists(file)) throw InputRefused(say("settings-file-is-there", file));
  const Interruptible interruptible;
  put("{}: {}.\n", type.name, type.tested);
  if (!check.yes) {
    const auto answer = answer_to("It is going to move. Is the space around it free, and its switch in reach? y:");
    if (!answer) throw WrongUsage(say("needs-an-answer"));
    if (*answer != 'y') return;
  }
  stylus.open();
  const device::Specification can = stylus.specification();
  put("Without the program: {}.\n", can.watchdog.empty() ? std::string(type.watchdog) : can.watchdog);
  if (!can.guardian.empty()) put("With it: {}.\n", can.guardian);
  const device::AxisCheck found = device::check_axes(
      stylus,
      {.ready =
           [&](const device::AxisPush& push) { return !Interruptible::interrupted() && may_push(push, check.yes); },
       .felt = [&](const device::AxisPush& push) { return felt(push, check.yes); },
       .home = [&] { put("To home it: {}.\n", type.homing); }},
      next_tick);
  const device::Specification specification = stylus.specification();
  stylus.close();
  say_result(found, stylus);
  if (found.ended || found.fault != device::Fault::none) {
    throw InputRefused(say("check-was-not-finished", std::string(type.name)));
  }
  if (writes) write_settings(check, file, found, specification);
  if (!found.is_right()) throw InputRefused(say("not-every-push-was-felt", std::string(type.name)));
}

}  // namespace palpate::plugin
