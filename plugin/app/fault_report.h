#pragma once

/// A file with the second before the last fault: the stylus' reports, the requested force, and the force sent. It
/// contains nothing of the scan.

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "device/safety/fault_log.h"
#include "solver/text/message.h"

namespace palpate::plugin {

struct FaultReport {
  std::string stylus;  ///< its own name
  std::string fault;   ///< as device::name_of()
  std::string time;    ///< of the report: "2026-01-31 13:05:07"
  std::filesystem::path file;
  double fastest_m_per_s = 0;  ///< up to the fault
  double strongest_n = 0;      ///< largest force sent, up to the fault
};

/// $XDG_STATE_HOME/palpate/last-fault.csv, or ~/.local/state/palpate/last-fault.csv; empty if there is neither.
std::filesystem::path fault_file();

/// Writes the file again. Does nothing if the ticks hold no fault, or if there is no place for the file. Never throws.
std::optional<FaultReport> keep_fault(std::span<const device::SafetyTick> ticks, const std::string& stylus) noexcept;
/// Reads the file. Never throws: a file that is not a report counts as none.
std::optional<FaultReport> last_fault() noexcept;
/// In a sentence.
Text describe(const FaultReport& report);

}  // namespace palpate::plugin
