#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "device/device_type.h"
#include "device/link/realtime.h"
#include "device/safety/guardian.h"
#include "plugin/app/errors.h"
#include "plugin/app/fault_report.h"
#include "plugin/app/stylus_choice.h"
#include "plugin/cli/check_device.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

using device::DeviceType;

Json about(const DeviceType& type) {
  return {{"kind", type.kind},     {"name", type.name}, {"can", type.can},       {"needs", type.needs},
          {"homing", type.homing}, {"sold", type.sold}, {"tested", type.tested}, {"watchdog", type.watchdog}};
}

Json entry(const DeviceType& type, const device::FoundDevice& found) {
  return {{"kind", type.kind}, {"name", found.name},    {"address", found.address}, {"accessible", found.accessible},
          {"can", type.can},   {"tested", type.tested}, {"note", found.note}};
}

void print_json(const std::vector<device::FoundDevice>& found, const device::RealtimeStatus& realtime) {
  Json list = Json::array();
  Json kinds = Json::array();
  for (const DeviceType* type : device::device_types()) {
    kinds.push_back(about(*type));
    if (type->find == nullptr) list.push_back(entry(*type, {"", std::string(type->name), "", true, ""}));
    for (const device::FoundDevice& one : found) {
      if (one.kind == type->kind) list.push_back(entry(*type, one));
    }
  }
  Json fault;
  if (const auto last = last_fault()) {
    fault = {{"stylus", last->stylus},
             {"fault", last->fault},
             {"time", last->time},
             {"fastest_m_per_s", last->fastest_m_per_s},
             {"strongest_n", last->strongest_n},
             {"file", last->file.string()}};
  }
  const Json json{
      {"devices", list},
      {"kinds", kinds},
      {"guardian", device::guardian_program()},
      {"guardian_leaves_group", device::guardian_can_leave_group()},
      {"last_fault", fault},
      {"realtime",
       {{"scheduled", realtime.scheduled}, {"memory_locked", realtime.memory_locked}, {"advice", realtime.advice}}}};
  put_json(json, 2);
}

void print_line(const char* head, std::string_view text) {
  if (!text.empty()) put("  {}{}\n", head, text);
}

void print_text(const std::vector<device::FoundDevice>& found, const device::RealtimeStatus& realtime) {
  std::puts("simulated\n  always there: 3 axes sensed, 3 with force; simulated in software, no hardware");
  for (const device::FoundDevice& one : found) {
    const DeviceType* const type = device::find_device_type(one.kind);
    put("{}  {}\n  '{}'\n", one.kind, one.address, one.name);
    if (!one.accessible) std::puts("  PERMISSION DENIED");
    print_line("", one.note);
    if (type == nullptr) continue;
    print_line("", type->can);
    print_line("needs: ", type->needs);
    print_line("to home: ", type->homing);
    print_line("if the program dies: ", type->watchdog);
    print_line("", type->tested);
  }
  if (found.empty()) std::puts("No other device was found: check its plug and its power supply.");
  std::puts("\nThere are drivers for:");
  for (const DeviceType* type : device::device_types()) {
    put("  {:<16} {} ({}): {}\n", type->kind, type->name, type->sold, type->tested);
  }
  put("\nReal time: {}\n", realtime.advice.empty() ? std::string("allowed") : std::string(realtime.advice));
  if (device::guardian_program().empty()) {
    std::puts("palpate-guardian was not found: after a crash only a device's own watchdog takes the force away.");
  } else if (!device::guardian_can_leave_group()) {
    put("{}\n",
        "palpate-guardian stays in the session's control group: this user has no systemd instance that could run it "
        "separately.");
  }
  if (const auto last = last_fault()) put("{}\n", describe(*last));
  std::puts("The drivers are tested against fakes of their protocols; they were never run on hardware.");
  std::puts("A session holds one stylus at a time. Torque stays zero, also on a stylus that senses how it is turned.");
}

/// Becomes palpate-faults, which plays the faults against the fakes of the devices. It lies beside this program, or
/// where $PALPATE_FAULTS says.
[[noreturn]] void play_faults(const std::string& kind, bool json) {
  if (!kind.empty()) type_of({.device = kind});
  const char* const named = std::getenv("PALPATE_FAULTS");
  std::error_code failed;
  std::string program =
      named != nullptr
          ? named
          : (std::filesystem::read_symlink("/proc/self/exe", failed).parent_path() / "palpate-faults").string();
  std::string wanted = kind, format = "--json";
  std::vector<char*> arguments{program.data()};
  if (!wanted.empty()) arguments.push_back(wanted.data());
  if (json) arguments.push_back(format.data());
  arguments.push_back(nullptr);
  std::fflush(nullptr);
  execv(program.c_str(), arguments.data());
  throw Refusal(say("faults-cannot-be-played", program, std::strerror(errno)));
}

}  // namespace

void add_devices(CLI::App& program) {
  CLI::App* const command = program.add_subcommand(
      "devices", "Lists the styluses that are plugged in, whether they can be opened, and what they can do");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print one JSON object");
  const auto check = std::make_shared<DeviceCheck>();
  CLI::Option* const which = command->add_option(
      "--check", check->stylus.device,
      "Check the axes of this stylus (KIND or KIND@ADDRESS): say what the hand should feel, ask whether to push, push\n"
      "with 0.2 N, and ask what was felt. Writes a settings file");
  command
      ->add_option("--firmware", check->stylus.firmware, "Falcon: Novint's firmware file, if the device has none yet")
      ->needs(which);
  command->add_option("--device-settings", check->stylus.settings, "Its present settings, a JSON file")->needs(which);
  command
      ->add_option("-o,--output", check->output,
                   "The file for its settings (default: KIND-settings.json in this folder)")
      ->needs(which);
  command->add_flag("--yes", check->yes, "Ask no questions: measure the direction of each push by the pose")
      ->needs(which);
  const auto kind = std::make_shared<std::string>();
  CLI::Option* const faults = command
                                  ->add_option("--faults", *kind,
                                               "Simulate each fault on an emulated device of each kind, or of KIND "
                                               "alone: prints the force that is left,\n"
                                               "the time until it is zero, and the largest step")
                                  ->expected(0, 1)
                                  ->excludes(which);
  command->callback([json, check, which, kind, faults] {
    if (faults->count() > 0) play_faults(*kind, *json);
    if (which->count() > 0) {
      check_device(*check);
      return;
    }
    const std::vector<device::FoundDevice> found = device::find_devices();
    const device::RealtimeStatus realtime = device::become_realtime();
    *json ? print_json(found, realtime) : print_text(found, realtime);
  });
}

}  // namespace palpate::plugin
