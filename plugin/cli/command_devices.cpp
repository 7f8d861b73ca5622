#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "device/device_type.h"
#include "device/link/realtime.h"
#include "device/safety/guardian.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"

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
  const Json json{
      {"devices", list},
      {"kinds", kinds},
      {"guardian", device::guardian_program()},
      {"realtime",
       {{"scheduled", realtime.scheduled}, {"memory_locked", realtime.memory_locked}, {"advice", realtime.advice}}}};
  std::puts(json.dump(2).c_str());
}

void print_line(const char* head, std::string_view text) {
  if (!text.empty()) std::printf("  %s%s\n", head, std::string(text).c_str());
}

void print_text(const std::vector<device::FoundDevice>& found, const device::RealtimeStatus& realtime) {
  std::puts("simulated\n  always there: 3 axes sensed, 3 with force; in arithmetic only");
  for (const device::FoundDevice& one : found) {
    const DeviceType* const type = device::find_device_type(one.kind);
    std::printf("%s  %s\n  '%s'\n", one.kind.c_str(), one.address.c_str(), one.name.c_str());
    if (!one.accessible) std::puts("  PERMISSION DENIED");
    print_line("", one.note);
    if (type == nullptr) continue;
    print_line("", type->can);
    print_line("needs: ", type->needs);
    print_line("to home: ", type->homing);
    print_line("without the program: ", type->watchdog);
    print_line("", type->tested);
  }
  if (found.empty()) std::puts("No other device was found: check its plug and its power supply.");
  std::puts("\nThere are drivers for:");
  for (const DeviceType* type : device::device_types()) {
    std::printf("  %-16s %s (%s): %s\n", std::string(type->kind).c_str(), std::string(type->name).c_str(),
                std::string(type->sold).c_str(), std::string(type->tested).c_str());
  }
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
