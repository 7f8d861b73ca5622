#include "plugin/report/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "modes/scene/ct_tissues.h"
#include "plugin/report/summary.h"
#include "plugin/session/session.h"
#include "solver/solution.h"

namespace palpate::plugin {

std::string tissue_name(const modes::Scene& scene, const std::string& unit, double value) {
  if (!std::isfinite(value)) {
    return "outside";
  }
  for (const modes::Tissue& tissue : scene.tissues) {
    if (value >= tissue.low && value <= tissue.high) {
      return tissue.name;
    }
  }
  if (unit == "HU") return modes::ct_tissue(value);
  return fmt::format("value {:.0f}", value);
}

std::string live_line(const TickRecord& frame, const std::string& tissue, double longest_tick_us,
                      std::uint64_t missed) {
  const double depth_mm = 1e3 * glm::length(vector_of(frame.proxy_m) - vector_of(frame.probe_m));
  std::string line = fmt::format(
      "{:7.1f} s  {:5.2f} N  {:5.1f} mm deep  {:<14} {:<10} +-{:.0e} m  tick {:6.1f} us  missed {}", frame.time_s,
      glm::length(vector_of(frame.sent_n)), depth_mm, tissue,
      solver::name_of(static_cast<solver::SolverKind>(frame.solver)), frame.error_bound_m, longest_tick_us, missed);
  if (fault_of(frame) != device::Fault::none) {
    line += fmt::format("  FAULT: {}", device::name_of(fault_of(frame)));
  } else if (state_of(frame) != device::State::active) {
    line += fmt::format("  {}", device::name_of(state_of(frame)));
  }
  return line;
}

LiveView::LiveView(const TickRing& ring, const modes::Scene& scene, std::string unit)
    : ring_(ring), scene_(scene), unit_(std::move(unit)) {}

LiveView::~LiveView() {
  fmt::print(stderr, "\r\033[K");
}

void LiveView::show() {
  const std::uint64_t written = ring_.written();
  next_ = std::max(next_, ring_.oldest());
  TickRecord frame;
  bool any = false;
  double longest_us = 0;
  for (; next_ < written; ++next_) {
    if (ring_.read(next_, frame)) {
      any = true;
      missed_ += frame.missed;
      longest_us = std::max(longest_us, tick_us(frame));
    }
  }
  if (any) {
    fmt::print(stderr, "\r{}\033[K", live_line(frame, tissue_name(scene_, unit_, frame.value), longest_us, missed_));
    std::fflush(stderr);
  }
}

}  // namespace palpate::plugin
