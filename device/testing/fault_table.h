#pragma once

/// The fault table: every event that can happen to a session, on every device's fake, through the one safety filter and
/// the link. The criterion is the force that the fake exerts, not the program's own state.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate::device {

/// What removes the force.
enum class EndedBy : std::uint8_t {
  nobody,    ///< the event is tolerated, and the force continues
  program,   ///< the session notices it
  guardian,  ///< only the guardian can
  device     ///< nothing can reach the device: only its own watchdog, if it has one
};
const char* name_of(EndedBy ended_by);

struct FaultRow {
  std::string device;
  std::string event;
  EndedBy ended_by = EndedBy::program;
  double seen_after_s = 0;             ///< latest time from the event until `ended_by` can notice it
  double before_n = 0;                 ///< N: at the event
  double allowed_n = 0;                ///< N: the largest allowed afterwards
  double largest_after_n = 0;          ///< N
  std::optional<double> zero_taken_s;  ///< from the event until the force stays zero; none if the device decides
  double left_n = 0;                   ///< N: on the device at the end
  int torques = 0;                     ///< that were commanded
  double largest_step_n = 0;           ///< N: largest change between two exchanges, except a fall to zero
  double allowed_step_n = 0;           ///< N: the slew ceiling for a late exchange, and the motors' rounding
};

/// The goal that a row misses; empty if all are met: no force above the one at the event; zero within 0.1 s of events
/// that the program notices, and 0.3 s of those that only the guardian notices; no step above the slew ceiling; no
/// torque.
std::string missed_goal(const FaultRow& row);

/// How the event ends on this device, briefly: "goes on", "device", or the time until the force is zero, with a note if
/// the guardian removes it. The largest force comes first if it is above the one at the event.
std::string brief(const FaultRow& row);

/// These rows as a table in Markdown: a row for each event, a column for each device.
std::string fault_matrix(std::span<const FaultRow> rows);

/// The rows of one device of rig_kinds().
std::vector<FaultRow> fault_table(const std::string& kind);

}  // namespace palpate::device
