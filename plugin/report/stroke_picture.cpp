#include "plugin/report/stroke_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/recording/table_file.h"
#include "plugin/report/held_boundary.h"
#include "plugin/report/live_view.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Color color_of(const modes::Scene& scene, std::size_t mode) {
  return color_from(scene.modes[mode].color, colors::vermilion);
}

std::vector<double> depths_of(const Profile& profile) {
  std::vector<double> depths;
  depths.reserve(profile.stroke.size());
  for (std::size_t n = 0; n < profile.stroke.size(); ++n) depths.push_back(depth_of(profile, n));
  return depths;
}

/// "skin (plane)"
std::string who_pushes(const Profile& profile, const StrokePoint& point) {
  return fmt::format("{} ({})", display_name(profile.scene, *point.boundary), solver::name_of(*point.primitive));
}

/// A curve for each boundary and type of primitive that pushes, and one for places where none does. The second type of
/// a boundary is dashed.
std::vector<Curve> force_curves(const Profile& profile, const std::vector<double>& depths) {
  const auto empty = [&](const std::string& label, const Color& color) {
    return Curve{.label = label, .x = depths, .y = std::vector<double>(depths.size(), not_a_number), .color = color};
  };
  Curve none = empty("", colors::gray);
  std::map<std::pair<std::size_t, solver::PrimitiveType>, Curve> by_pusher;
  for (std::size_t n = 0; n < depths.size(); ++n) {
    const StrokePoint& point = profile.stroke[n];
    Curve* curve = &none;
    if (point.boundary) {
      const std::pair pusher{*point.boundary, *point.primitive};
      auto found = by_pusher.find(pusher);
      if (found == by_pusher.end()) {
        const bool second = std::any_of(by_pusher.begin(), by_pusher.end(),
                                        [&](const auto& other) { return other.first.first == pusher.first; });
        found =
            by_pusher.emplace(pusher, empty(who_pushes(profile, point), color_of(profile.scene, pusher.first))).first;
        found->second.dashed = second;
      }
      curve = &found->second;
    }
    curve->y[n] = glm::length(point.force_n);
    // The next stretch begins where this one ends, so that the line has no gaps.
    if (n > 0) curve->y[n - 1] = glm::length(profile.stroke[n - 1].force_n);
  }
  std::vector<Curve> curves{std::move(none)};
  for (auto& [pusher, curve] : by_pusher) curves.push_back(std::move(curve));
  return curves;
}

/// The named tissue: the scene's, or CT's.
std::string tissue_of(const Profile& profile, double value) {
  if (!std::isfinite(value)) return {};
  const bool held =
      std::any_of(profile.scene.tissues.begin(), profile.scene.tissues.end(),
                  [&](const modes::Tissue& tissue) { return value >= tissue.low && value <= tissue.high; });
  if (!held && profile.unit != "HU") return {};
  return tissue_name(profile.scene, profile.unit, value);
}

std::vector<Band> tissues_crossed(const Profile& profile, const std::vector<double>& depths) {
  constexpr Color darker{0.93, 0.93, 0.93}, lighter{0.98, 0.98, 0.98};
  std::vector<Band> bands;
  std::string last;
  for (std::size_t n = 0; n < depths.size(); ++n) {
    const std::string name = tissue_of(profile, profile.stroke[n].value_passed);
    if (!name.empty() && name == last) {
      bands.back().to = depths[n];
    } else if (!name.empty()) {
      bands.push_back({depths[n], depths[n], name, bands.size() % 2 == 0 ? darker : lighter});
    }
    last = name;
  }
  return bands;
}

/// How far the true boundary may be, before and behind.
std::vector<Band> uncertainties(const Profile& profile) {
  constexpr double tint = 0.35;
  std::vector<Band> bands;
  for (const MetBoundary& met : profile.met) {
    if (!met.known_along_mm) continue;
    Color color = color_of(profile.scene, met.contact.boundary);
    color.alpha = tint;
    bands.push_back({met.depth_mm - *met.known_along_mm, met.depth_mm + *met.known_along_mm, "", color});
  }
  return bands;
}

const MetBoundary* met_at(const Profile& profile, std::size_t point) {
  const auto met = std::ranges::find_if(
      profile.met, [&](const MetBoundary& one) { return point >= one.contact.first && point <= one.contact.last; });
  return met == profile.met.end() ? nullptr : &*met;
}

}  // namespace

std::vector<MetBoundary> met_along(const Profile& profile, const PreparedScene& felt) {
  constexpr double least_cosine = 0.1;  // 84 degrees
  std::vector<Contact> contacts = contacts_of(profile.stroke, *profile.plan, met_n);
  add_strengths(contacts, profile.stroke, *profile.plan, *felt.source);
  const glm::dvec3 start = profile.stroke.front().position_mm;
  const glm::dvec3 along = glm::normalize(profile.stroke.back().position_mm - start);
  std::vector<MetBoundary> all;
  for (const Contact& contact : contacts) {
    const glm::dvec3 place = profile.stroke[contact.first].proxy_mm;
    MetBoundary met{.contact = contact,
                    .depth_mm = glm::dot(place - start, along),
                    .known_to_mm = known_to_mm(felt, profile.scene, contact.boundary, place),
                    .known_along_mm = std::nullopt};
    if (met.known_to_mm) {
      const glm::dvec3 gradient = felt.source->sample(place, io::FieldSet::gradient).gradient;
      const double cosine = std::abs(glm::dot(glm::normalize(gradient), along));
      if (cosine > least_cosine) met.known_along_mm = *met.known_to_mm / cosine;
    }
    all.push_back(met);
  }
  return all;
}

double depth_of(const Profile& profile, std::size_t point) {
  return glm::distance(profile.stroke[point].position_mm, profile.stroke.front().position_mm);
}

Profile thinned(const Profile& profile, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, profile.stroke.size() / most);
  Profile thin{
      .stroke = {}, .plan = profile.plan, .scene = profile.scene, .unit = profile.unit, .limit_n = profile.limit_n};
  for (std::size_t n = 0; n < profile.stroke.size(); n += stride) thin.stroke.push_back(profile.stroke[n]);
  thin.met = profile.met;
  for (MetBoundary& met : thin.met) {
    met.contact.first /= stride;
    met.contact.last /= stride;
  }
  return thin;
}

std::vector<Chart> charts_of(const Profile& profile) {
  const std::vector<double> depths = depths_of(profile);
  Curve passed{.label = "at the probe", .x = depths, .y = {}, .color = colors::blue};
  Curve held{.label = "at the proxy", .x = depths, .y = {}, .color = colors::orange, .width = 1.2};
  Curve ahead{.label = "", .x = depths, .y = {}, .color = colors::green};
  for (const StrokePoint& point : profile.stroke) {
    passed.y.push_back(point.value_passed);
    held.y.push_back(point.value);
    ahead.y.push_back(glm::distance(point.position_mm, point.proxy_mm));
  }
  std::vector<Mark> marks;
  for (const MetBoundary& met : profile.met) {
    marks.push_back({.at = met.depth_mm, .label = display_name(profile.scene, met.contact.boundary)});
  }
  const auto chart = [&](const std::string& title, const std::string& label, std::vector<Curve> curves) {
    Chart made;
    made.title = title;
    made.x.label = "distance along the stroke (mm)";
    made.y.label = label;
    made.curves = std::move(curves);
    made.marks = marks;
    return made;
  };
  std::vector<Chart> charts;
  charts.push_back(chart("Force along the stroke: " + profile.scene.name, "force (N)", force_curves(profile, depths)));
  charts.push_back(
      chart("Value and tissues", profile.unit.empty() ? "value" : "value (" + profile.unit + ")", {passed, held}));
  charts.back().bands = tissues_crossed(profile, depths);
  charts.push_back(chart("Distance from proxy to probe", "distance (mm)", {ahead}));
  for (Chart& drawn : charts) std::ranges::copy(uncertainties(profile), std::back_inserter(drawn.bands));
  // Rounding alone does not fill a chart.
  constexpr double least_mm = 0.5, least_n = 0.2, room = 1.08;
  const auto reach = [&](Chart& drawn, double least) {
    double most = least;
    for (const Curve& curve : drawn.curves) {
      for (const double y : curve.y) most = std::max(most, std::isfinite(y) ? room * y : most);
    }
    drawn.y.minimum = 0;
    drawn.y.maximum = most;
  };
  reach(charts.front(), least_n);
  reach(charts.back(), least_mm);
  return charts;
}

void write_csv(const Profile& profile, const std::filesystem::path& file) try {
  TableFile out(file);
  out.print(
      "depth_mm,probe_x_mm,probe_y_mm,probe_z_mm,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,"
      "force_n,value_at_probe,value_at_proxy,tissue,boundary,primitive,solver,error_bound_m,known_to_mm\n");
  const auto quoted = [](const std::string& text) {
    std::string out_text = "\"";
    for (const char c : text) {
      if (c == '"') out_text += '"';
      out_text += c;
    }
    return out_text + '"';
  };
  for (std::size_t n = 0; n < profile.stroke.size(); ++n) {
    const StrokePoint& point = profile.stroke[n];
    out.print("{}", depth_of(profile, n));
    for (const glm::dvec3& v : {point.position_mm, point.proxy_mm, point.force_n}) {
      out.print(",{},{},{}", v.x, v.y, v.z);
    }
    const MetBoundary* const met = met_at(profile, n);
    out.print(",{},{},{},{},{},{},{},{},{}\n", glm::length(point.force_n), point.value_passed, point.value,
              quoted(tissue_of(profile, point.value_passed)),
              quoted(point.boundary ? display_name(profile.scene, *point.boundary) : ""),
              point.primitive ? solver::name_of(*point.primitive) : "", solver::name_of(point.solver),
              point.error_bound_m, met ? met->known_to_mm.value_or(not_a_number) : not_a_number);
  }
  out.close();
} catch (const std::exception& error) {
  throw Refusal(say("table-cannot-be-written", file.string(), error.what()));
}

std::string point_in_words(const Profile& profile, std::size_t point) {
  const StrokePoint& at = profile.stroke[point];
  std::string words = fmt::format("{:.1f} mm: {:.2f} N", depth_of(profile, point), glm::length(at.force_n));
  if (at.boundary) words += " by " + who_pushes(profile, at);
  if (!std::isfinite(at.value_passed)) return words + ", outside the scan";
  words += fmt::format(", {:.0f}{}{}", at.value_passed, profile.unit.empty() ? "" : " ", profile.unit);
  const std::string tissue = tissue_of(profile, at.value_passed);
  return tissue.empty() ? words : words + ", " + tissue;
}

}  // namespace palpate::plugin
