#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "device/found_devices.h"
#include "device/link/realtime.h"
#include "device/safety/guardian.h"
#include "device/simulated/simulated_stylus.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

/// What a kind of device can do: of its driver's defaults, without opening the device.
struct Ability {
  const char* kind;
  const char* can;
};
constexpr Ability abilities[] = {
    {"falcon", "3 axes sensed, 3 with force; Novint's firmware file is needed after it was switched on"},
    {"wooden_haptics", "3 axes sensed, 3 with force; its geometry comes from a JSON file"},
    {"space_mouse", "3 axes sensed as a rate, no force"},
};

const char* ability_of(const std::string& kind) {
  for (const Ability& ability : abilities) {
    if (kind == ability.kind) return ability.can;
  }
  return "";
}

void print_json(const std::vector<device::FoundDevice>& found, const device::RealtimeStatus& realtime) {
  Json list = Json::array();
  const device::Specification simulated = device::SimulatedStylus().specification();
  list.push_back({{"kind", "simulated"},
                  {"name", simulated.name},
                  {"address", ""},
                  {"accessible", true},
                  {"can", "3 axes sensed, 3 with force; in arithmetic only"},
                  {"note", ""}});
  for (const device::FoundDevice& one : found) {
    list.push_back({{"kind", one.kind},
                    {"name", one.name},
                    {"address", one.address},
                    {"accessible", one.accessible},
                    {"can", ability_of(one.kind)},
                    {"note", one.note}});
  }
  const Json json{
      {"devices", list},
      {"guardian", device::guardian_program()},
      {"realtime",
       {{"scheduled", realtime.scheduled}, {"memory_locked", realtime.memory_locked}, {"advice", realtime.advice}}}};
  std::puts(json.dump(2).c_str());
}

void print_text(const std::vector<device::FoundDevice>& found, const device::RealtimeStatus& realtime) {
  std::puts("simulated\n  always there: 3 axes sensed, 3 with force; in arithmetic only");
  for (const device::FoundDevice& one : found) {
    std::printf("%s  %s\n  '%s': %s\n", one.kind.c_str(), one.address.c_str(), one.name.c_str(), ability_of(one.kind));
    if (!one.accessible) std::puts("  PERMISSION DENIED");
    if (!one.note.empty()) std::printf("  %s\n", one.note.c_str());
  }
  if (found.empty()) std::puts("No other device was found: check its plug and its power supply.");
  std::printf("\nReal time: %s\n", realtime.advice.empty() ? "allowed" : realtime.advice.c_str());
  if (device::guardian_program().empty()) {
    std::puts("palpate-guardian was not found: after a crash only a device's own watchdog takes the force away.");
  }
  std::puts("The drivers are tested against fakes of their protocols; they were never run on hardware.");
}

}  // namespace

void add_devices(CLI::App& program) {
  CLI::App* const command =
      program.add_subcommand("devices", "Styluses found, whether they can be opened, what they can do");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "For machines: one JSON object");
  command->callback([json] {
    const std::vector<device::FoundDevice> found = device::find_devices();
    const device::RealtimeStatus realtime = device::become_realtime();
    *json ? print_json(found, realtime) : print_text(found, realtime);
  });
}

}  // namespace palpate::plugin
