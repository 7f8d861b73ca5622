#pragma once

/// The fault table: every event that can befall a session, on every device's fake, through the one safety filter and
/// the link. What counts is the force that the fake exerts, not what the program thinks of it.

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace palpate::device {

/// Who takes the force away.
enum class EndedBy : std::uint8_t {
  nobody,    ///< the event is borne, and the force goes on
  program,   ///< the session sees it
  guardian,  ///< only the guardian can
  device     ///< nobody can reach it: its own watchdog, if it has one
};
const char* name_of(EndedBy ended_by);

struct FaultRow {
  std::string device;
  std::string event;
  EndedBy ended_by = EndedBy::program;
  double seen_after_s = 0;             ///< from the event until who ends it can see it, at the latest
  double before_n = 0;                 ///< N: at the event
  double allowed_n = 0;                ///< N: the most that may follow
  double largest_after_n = 0;          ///< N
  std::optional<double> zero_taken_s;  ///< from the event until the force is zero for good; none if the device decides
  double left_n = 0;                   ///< N: on the device at the end
  int torques = 0;                     ///< that were asked for
  double largest_step_n = 0;           ///< N: largest change between two exchanges that is no fall to zero
  double allowed_step_n = 0;           ///< N: what the slew ceiling allows in a late exchange, and the motors' rounding
};

/// The goals of a row: no force above what it was; a zero within 0.1 s of what the program sees and 0.3 s of what only
/// the guardian sees; no step above the slew ceiling; no torque. Empty if all are met.
std::string missed_goal(const FaultRow& row);

/// How the event ends on this device, in few words: "goes on"; "device"; the time until the force is zero, and whether
/// the guardian takes it; before it the largest force, where it is above the force at the event.
std::string brief(const FaultRow& row);

/// These rows as a table in Markdown: a row for each event, a column for each device.
std::string fault_matrix(std::span<const FaultRow> rows);

/// The rows of one device of rig_kinds().
std::vector<FaultRow> fault_table(const std::string& kind);

}  // namespace palpate::device
