#pragma once

/// A file with the second before the last fault: what the stylus reported, what force was asked for, and what was sent.
/// It holds nothing of the scan.

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "device/safety/fault_log.h"
#include "solver/text/message.h"

namespace palpate::plugin {

struct FaultReport {
  std::string stylus;  ///< as it calls itself
  std::string fault;   ///< as device::name_of()
  std::string time;    ///< when it was kept: "2026-01-31 13:05:07"
  std::filesystem::path file;
  double fastest_m_per_s = 0;  ///< up to the fault
  double strongest_n = 0;      ///< that was sent, likewise
};

/// $XDG_STATE_HOME/palpate/last-fault.csv, or ~/.local/state/palpate/last-fault.csv; empty if there is neither.
std::filesystem::path fault_file();

/// Writes the file again. Does nothing if the ticks hold no fault, or if there is no place for the file. Never throws.
std::optional<FaultReport> keep_fault(std::span<const device::SafetyTick> ticks, const std::string& stylus) noexcept;
/// Reads the file that was written last. Never throws: a file that is not a report counts as none.
std::optional<FaultReport> last_fault() noexcept;
/// In a sentence.
Text describe(const FaultReport& report);

}  // namespace palpate::plugin
