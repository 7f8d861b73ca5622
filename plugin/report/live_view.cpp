#include "plugin/report/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <utility>

#include "modes/scene/ct_tissues.h"
#include "plugin/report/summary.h"
#include "plugin/session/session.h"
#include "solver/solver_type.h"
#include "solver/text/printable.h"

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

std::string live_line(const TickRecord& tick, const std::string& tissue, double longest_tick_us, std::uint64_t missed) {
  const double depth_mm = 1e3 * glm::length(vector_of(tick.proxy_m) - vector_of(tick.probe_m));
  std::string line =
      fmt::format("{:7.1f} s  {:5.2f} N  {:5.1f} mm deep  {:<14} {:<10} +-{:.0e} m  tick {:6.1f} us  missed {}",
                  tick.time_s, glm::length(vector_of(tick.sent_n)), depth_mm, tissue,
                  solver::name_of(solver::solver_of_number(tick.solver)), tick.error_bound_m, longest_tick_us, missed);
  if (fault_of(tick) != device::Fault::none) {
    line += fmt::format("  FAULT: {}", device::name_of(fault_of(tick)));
  } else if (state_of(tick) != device::State::active) {
    line += fmt::format("  {}", device::name_of(state_of(tick)));
  }
  return line;
}

LiveView::LiveView(const TickRing& ring, const modes::Scene& scene, std::string unit)
    : ring_(ring), scene_(scene), unit_(std::move(unit)) {}

// Not by fmt::print, which throws where the terminal is gone: the session goes on.
LiveView::~LiveView() {
  std::fputs("\r\033[K", stderr);
}

void LiveView::show() {
  const std::uint64_t written = ring_.written();
  next_ = std::max(next_, ring_.oldest());
  TickRecord tick;
  bool any = false;
  double longest_us = 0;
  for (; next_ < written; ++next_) {
    if (ring_.read(next_, tick)) {
      any = true;
      missed_ += tick.missed;
      longest_us = std::max(longest_us, tick_us(tick));
    }
  }
  if (any) {
    const std::string tissue = printable(tissue_name(scene_, unit_, tick.value));  // a scene's file names it
    std::fputs(fmt::format("\r{}\033[K", live_line(tick, tissue, longest_us, missed_)).c_str(), stderr);
    std::fflush(stderr);
  }
}

}  // namespace palpate::plugin
