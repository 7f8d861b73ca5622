#pragma once

/// The time of a tick: a session runs over given poses, without waiting for a device. Every tick is timed from outside
/// and stage by stage.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "plugin/report/summary.h"
#include "plugin/session/session.h"

namespace palpate::plugin {

struct TickRow {
  std::string what;
  std::size_t ticks = 0;
  Percentiles us;                                   ///< of a whole tick, including writing it to the ring
  std::array<double, stage_count> stage_mean_ns{};  ///< mean, since the median of a stage of 20 ns says little
  double primitives = 0;                            ///< mean of a tick
  double sub_steps = 0;                             ///< mean
  double from_brick = 0;                            ///< fraction of ticks whose gradient was precomputed
};

/// Runs the work on a thread of its own, with the servo's scheduling if the system allows it, and waits for it.
void run_as_servo(const std::function<void()>& work);

/// To be called after every tick by a servo that does not keep the clock's pace. Sleeps now and then, as every servo
/// does between its ticks, so that the worker that computes fields ahead can run.
void pause_now_and_then(std::size_t tick);

enum class Between : std::uint8_t { asleep, awake };

/// Runs ticks over the poses (device frame, m), alternately forwards and backwards, so that none jumps. The first tenth
/// is not measured. With a rate (Hz) the ticks keep the clock's pace: asleep between them like the servo, so that other
/// work runs and uses the caches, or awake. 0: they run nearly back to back.
TickRow measure_ticks(const std::string& what, const Snapshot& snapshot, std::span<const glm::dvec3> poses_m,
                      std::size_t ticks, double rate_hz = 0, Between between = Between::asleep);

/// While this exists, another thread keeps a core and the memory busy.
class BusyThread {
 public:
  BusyThread();
  BusyThread(const BusyThread&) = delete;
  BusyThread& operator=(const BusyThread&) = delete;
  ~BusyThread();

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

/// One line for a person, and its header.
std::string to_text(const TickRow& row);
std::string tick_row_header();
std::string to_csv(const TickRow& row);
std::string tick_csv_header();

}  // namespace palpate::plugin
