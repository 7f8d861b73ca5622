#include "plugin/app/fault_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <glm/geometric.hpp>
#include <sstream>
#include <string_view>
#include <system_error>

#include "plugin/messages/messages.h"

namespace palpate::plugin {

namespace {

constexpr std::string_view columns =
    "time_s,stylus_state,x_m,y_m,z_m,fresh,speed_m_per_s,asked_x_n,asked_y_n,asked_z_n,sent_x_n,sent_y_n,sent_z_n,gain,"
    "fault";

std::string row_of(const device::SafetyTick& tick) {
  const device::Vec3& p = tick.input.reading.position;
  const device::Vec3& asked = tick.input.force;
  const device::Vec3& sent = tick.result.force;
  return fmt::format("{:.6f},{},{:.9g},{:.9g},{:.9g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.4g},{}\n",
                     tick.input.time, device::name_of(tick.input.device), p.x, p.y, p.z,
                     tick.input.reading.fresh ? 1 : 0, tick.result.speed, asked.x, asked.y, asked.z, sent.x, sent.y,
                     sent.z, tick.result.gain, device::name_of(tick.result.fault));
}

FaultReport report_of(std::span<const device::SafetyTick> ticks, const std::string& stylus) {
  FaultReport report;
  report.stylus = stylus;
  std::replace(report.stylus.begin(), report.stylus.end(), '\n', ' ');
  for (const device::SafetyTick& tick : ticks) {
    report.fastest_m_per_s = std::max(report.fastest_m_per_s, tick.result.speed);
    report.strongest_n = std::max(report.strongest_n, glm::length(tick.result.force));
    if (tick.result.fault == device::Fault::none) continue;
    report.fault = device::name_of(tick.result.fault);
    break;
  }
  const std::time_t now = std::time(nullptr);
  report.time = fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::localtime(now));
  report.file = fault_file();
  return report;
}

/// The text after "# key: "; empty if it is another line.
std::string_view value_of(std::string_view line, std::string_view key) {
  if (!line.starts_with("# ") || !line.substr(2).starts_with(key)) return {};
  line.remove_prefix(2 + key.size());
  return line.starts_with(": ") ? line.substr(2) : std::string_view();
}

}  // namespace

std::filesystem::path fault_file() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  const std::filesystem::path file = std::filesystem::path("palpate") / "last-fault.csv";
  if (state != nullptr && *state == '/') return state / file;
  if (home != nullptr && *home == '/') return std::filesystem::path(home) / ".local" / "state" / file;
  return {};
}

std::optional<FaultReport> keep_fault(std::span<const device::SafetyTick> ticks, const std::string& stylus) noexcept {
  try {
    FaultReport report = report_of(ticks, stylus);
    if (report.fault.empty() || report.file.empty()) return {};
    std::filesystem::create_directories(report.file.parent_path());
    std::string text =
        fmt::format("# stylus: {}\n# fault: {}\n# time: {}\n# fastest: {:.3f} m/s\n# strongest: {:.3f} N\n",
                    report.stylus, report.fault, report.time, report.fastest_m_per_s, report.strongest_n);
    text.append(columns).append("\n");
    for (const device::SafetyTick& tick : ticks) text += row_of(tick);
    std::filesystem::path part = report.file;
    part += ".partial";
    std::ofstream stream(part);
    if (!stream.write(text.data(), static_cast<std::streamsize>(text.size())).flush()) return {};
    std::filesystem::rename(part, report.file);
    return report;
  } catch (const std::exception&) {
    return {};
  }
}

std::optional<FaultReport> last_fault() noexcept {
  try {
    FaultReport report;
    report.file = fault_file();
    std::ifstream stream(report.file);
    std::string line;
    while (std::getline(stream, line) && line.starts_with('#')) {
      if (const auto stylus = value_of(line, "stylus"); !stylus.empty()) report.stylus = stylus;
      if (const auto fault = value_of(line, "fault"); !fault.empty()) report.fault = fault;
      if (const auto time = value_of(line, "time"); !time.empty()) report.time = time;
      if (const auto speed = value_of(line, "fastest"); !speed.empty())
        report.fastest_m_per_s = std::stod(std::string(speed));
      if (const auto force = value_of(line, "strongest"); !force.empty())
        report.strongest_n = std::stod(std::string(force));
    }
    if (report.fault.empty()) return {};
    return report;
  } catch (const std::exception&) {
    return {};
  }
}

Text describe(const FaultReport& report) {
  return say("the-second-before-the-fault", report.time, report.stylus, report.fault,
             fmt::format("{:.2f}", report.fastest_m_per_s), fmt::format("{:.2f}", report.strongest_n),
             report.file.string());
}

}  // namespace palpate::plugin
