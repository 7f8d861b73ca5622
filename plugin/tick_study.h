#pragma once

/// What a tick costs: a session run over given poses, without a device to wait for, every tick timed from outside and
/// stage by stage.

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "palpate/plugin/session.h"
#include "palpate/plugin/summary.h"

namespace palpate::plugin {

struct TickRow {
  std::string what;
  std::size_t ticks = 0;
  Percentiles us;                                   ///< of a whole tick, the frame's way into the ring included
  std::array<double, stage_count> stage_mean_ns{};  ///< the median of a stage of 20 ns says little
  double primitives = 0;                            ///< mean of a frame
  double sub_steps = 0;                             ///< mean
  double from_brick = 0;                            ///< share of frames whose gradient was ready
};

/// Ticks over the poses (device frame, m), there and back again and again so that none jumps; what is measured begins
/// after a tenth of them.
TickRow measure_ticks(const std::string& what, const Snapshot& snapshot, std::span<const glm::dvec3> poses_m,
                      std::size_t ticks);

/// While it lives, another thread keeps a core and the memory busy.
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
