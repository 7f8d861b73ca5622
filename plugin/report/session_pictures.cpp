#include "plugin/report/session_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "plugin/report/chart.h"
#include "plugin/report/slice_picture.h"

namespace palpate::plugin {
namespace {

constexpr std::array boundary_colors{colors::vermilion, colors::blue,   colors::green,
                                     colors::purple,    colors::orange, colors::sky};

/// The session's tracks in the patient.
struct Tracks {
  std::vector<glm::dvec3> probe_mm, proxy_mm, force_n;
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};
};

Tracks tracks_of(const Recording& recording, const modes::Plan& plan) {
  Tracks tracks;
  for (const TickRecord& tick : recording.ticks) {
    tracks.probe_mm.push_back(plan.workspace.to_patient(vector_of(tick.probe_m)));
    tracks.proxy_mm.push_back(plan.workspace.to_patient(vector_of(tick.proxy_m)));
    tracks.force_n.push_back(plan.workspace.direction_to_patient(vector_of(tick.sent_n)));
    tracks.low = glm::min(tracks.low, tracks.probe_mm.back());
    tracks.high = glm::max(tracks.high, tracks.probe_mm.back());
  }
  return tracks;
}

SliceView view_of(const Tracks& tracks, const std::string& unit, const io::FieldSource& source) {
  const glm::dvec3 size = tracks.high - tracks.low;
  SliceView view;
  view.center_mm = 0.5 * (tracks.low + tracks.high);
  view.extent_mm = std::max(60.0, 2.2 * std::max({size.x, size.y, size.z}));
  if (size.z <= size.x && size.z <= size.y) {
    view.right = {1, 0, 0};
    view.down = {0, 1, 0};
  } else if (size.y <= size.x) {
    view.right = {1, 0, 0};
    view.down = {0, 0, -1};
  } else {
    view.right = {0, 1, 0};
    view.down = {0, 0, -1};
  }
  if (unit == "HU") {
    view.window_level = 100;
    view.window_width = 1400;
    return view;
  }
  // No absolute scale: the window covers the values around the path.
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (int n = 0; n < 4096; ++n) {
    const glm::dvec2 at{(n % 64) / 63.0 - 0.5, (n / 64) / 63.0 - 0.5};  // NOLINT: whole rows are meant
    const io::Sample sample =
        source.sample(view.center_mm + view.extent_mm * (at.x * view.right + at.y * view.down), io::FieldSet::value);
    if (sample.inside) {
      low = std::min(low, sample.value);
      high = std::max(high, sample.value);
    }
  }
  if (low < high) {
    view.window_level = 0.5 * (low + high);
    view.window_width = high - low;
  }
  return view;
}

std::vector<ForceArrow> arrows_of(const Tracks& tracks) {
  std::vector<ForceArrow> arrows;
  glm::dvec3 last(std::numeric_limits<double>::infinity());
  for (std::size_t n = 0; n < tracks.proxy_mm.size(); n += 10) {
    // So the holds do not pile up.
    if (glm::length(tracks.force_n[n]) > 0.05 && !(glm::distance(last, tracks.probe_mm[n]) < 1.0)) {
      arrows.push_back({.at_mm = tracks.proxy_mm[n], .force_n = tracks.force_n[n]});
      last = tracks.probe_mm[n];
    }
  }
  return arrows;
}

void write_slice(const Tracks& tracks, const SliceView& view, const io::FieldSource& source,
                 const std::filesystem::path& file) {
  const std::vector<ForceArrow> arrows = arrows_of(tracks);
  const std::array shown{Track{"probe: the stylus's tip", tracks.probe_mm, colors::orange, 2},
                         Track{"proxy: what is felt there", tracks.proxy_mm, colors::sky, 2},
                         Track{"force on the hand", {}, colors::green, 2}};
  write_slice_png(source, view, shown, arrows, "Path of the stylus through the scan", file);
}

}  // namespace

std::array<Chart, 2> force_depth_charts(const Recording& recording, const Summary& summary, const modes::Scene& scene,
                                        const modes::Plan& plan, const std::string& unit) {
  const Tracks tracks = tracks_of(recording, plan);
  glm::dvec3 outward{0};
  for (const glm::dvec3& force : tracks.force_n) {
    outward += force;
  }
  const double total = glm::length(outward);
  const glm::dvec3 inward = total > 0 ? -outward / total : glm::dvec3(0, 1, 0);
  const glm::dvec3 origin = summary.holds.empty() ? tracks.probe_mm.front() : summary.holds.front().contact_mm;
  const auto depth_of = [&](const glm::dvec3& point) { return glm::dot(point - origin, inward); };

  Curve in{.label = "force, going in", .x = {}, .y = {}, .color = colors::vermilion, .width = 1.5};
  Curve out{.label = "force, coming out", .x = {}, .y = {}, .color = colors::sky, .width = 1.5};
  Curve value{.label = "value at the proxy", .x = {}, .y = {}, .color = colors::blue, .width = 1.5};
  const auto deepest = std::max_element(tracks.probe_mm.begin(), tracks.probe_mm.end(),
                                        [&](const auto& a, const auto& b) { return depth_of(a) < depth_of(b); });
  const auto turn = static_cast<std::size_t>(deepest - tracks.probe_mm.begin());
  for (std::size_t n = 0; n < tracks.probe_mm.size(); ++n) {
    Curve& curve = n <= turn ? in : out;
    curve.x.push_back(depth_of(tracks.probe_mm[n]));
    curve.y.push_back(glm::length(tracks.force_n[n]));
    value.x.push_back(depth_of(tracks.probe_mm[n]));
    value.y.push_back(recording.ticks[n].value);
  }
  std::vector<Mark> marks;
  std::vector<std::size_t> named;
  for (const HeldStretch& hold : summary.holds) {
    if (std::find(named.begin(), named.end(), hold.mode) == named.end()) {
      named.push_back(hold.mode);
      marks.push_back({.at = depth_of(hold.contact_mm),
                       .label = fmt::format("{}: {:.0f} {}", display_name(scene, hold.mode), hold.value, unit),
                       .color = boundary_colors[(named.size() - 1) % boundary_colors.size()]});
    }
  }
  return {Chart{"Force against depth", {"depth of the probe (mm)"}, {"force (N)"}, {in, out}, marks},
          Chart{"Value against depth",
                {"depth of the probe (mm)"},
                {unit.empty() ? "value" : fmt::format("value ({})", unit)},
                {value},
                marks}};
}

Chart force_time_chart(const Recording& recording, const modes::Scene& scene) {
  std::vector<Curve> by_mode(scene.modes.size());
  Curve sent{.label = "sent to the device", .x = {}, .y = {}, .color = colors::black, .width = 1.6};
  std::size_t share = 0;
  for (const TickRecord& tick : recording.ticks) {
    sent.x.push_back(tick.time_s);
    sent.y.push_back(glm::length(vector_of(tick.sent_n)));
    std::vector<glm::dvec3> force(scene.modes.size(), glm::dvec3(0));
    for (std::uint32_t n = 0; n < tick.share_count; ++n, ++share) {
      // Shares left from a previous scene are not of this scene's modes.
      if (recording.shares[share].mode < force.size()) {
        force[recording.shares[share].mode] += vector_of(recording.shares[share].force_n);
      }
    }
    for (std::size_t mode = 0; mode < scene.modes.size(); ++mode) {
      by_mode[mode].x.push_back(tick.time_s);
      by_mode[mode].y.push_back(glm::length(force[mode]));
    }
  }
  Chart chart{"Force over time, and which mode made it", {"time (s)"}, {"force (N)"}, {sent}, {}};
  for (std::size_t mode = 0; mode < by_mode.size(); ++mode) {
    by_mode[mode].label = display_name(scene, mode);
    by_mode[mode].color = boundary_colors[mode % boundary_colors.size()];
    chart.curves.push_back(by_mode[mode]);
  }
  return chart;
}

Chart tick_time_chart(const Recording& recording, const Summary& summary) {
  // Twenty bins a decade from 0.1 us to 10 ms.
  constexpr int bins = 100;
  Curve counts{
      .label = "", .x = {}, .y = std::vector<double>(bins + 1, 0), .color = colors::sky, .style = Curve::Style::bars};
  for (int bin = 0; bin <= bins; ++bin) {
    counts.x.push_back(0.1 * std::pow(10.0, bin / 20.0));
  }
  for (const TickRecord& tick : recording.ticks) {
    const double bin = std::floor(20 * std::log10(std::max(0.1, tick_us(tick)) / 0.1));
    counts.y[static_cast<std::size_t>(std::min<double>(bins - 1, bin))] += 1;
  }
  // Bars need a height on a logarithmic axis; an empty bin has none.
  Chart chart{"Time of a tick", {"time (us)", true, 0.1, 1e4}, {"ticks", true, 0.5}, {counts}, {}};
  chart.marks = {{.at = summary.tick_us.median, .label = fmt::format("median {:.2f} us", summary.tick_us.median)},
                 {.at = summary.tick_us.p999, .label = fmt::format("99.9 % {:.2f} us", summary.tick_us.p999)},
                 {.at = 1000, .label = "1 ms: the tick's period", .color = colors::vermilion}};
  return chart;
}

SliceView slice_view(const Recording& recording, const modes::Plan& plan, const std::string& unit,
                     const io::FieldSource& source) {
  return view_of(tracks_of(recording, plan), unit, source);
}

std::vector<ForceArrow> force_arrows(const Recording& recording, const modes::Plan& plan) {
  return arrows_of(tracks_of(recording, plan));
}

std::vector<std::string> write_session_pictures(const Recording& recording, const Summary& summary,
                                                const modes::Scene& scene, const modes::Plan& plan,
                                                const io::FieldSource& source, const std::string& unit,
                                                const std::filesystem::path& folder) {
  if (recording.ticks.empty()) {
    return {};
  }
  const Tracks tracks = tracks_of(recording, plan);
  write_slice(tracks, view_of(tracks, unit, source), source, folder / "slice.png");
  write_png(force_depth_charts(recording, summary, scene, plan, unit), folder / "force-depth.png");
  write_png(force_time_chart(recording, scene), folder / "force-time.png");
  write_png(tick_time_chart(recording, summary), folder / "tick-time.png");
  return {"slice.png", "force-depth.png", "force-time.png", "tick-time.png"};
}

}  // namespace palpate::plugin
