#include "plugin/report/chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace palpate::plugin {
namespace {

/// Data to pixels along one axis.
struct Scale {
  double low = 0, high = 1;  // in the data, or its logarithm
  double from = 0, to = 1;   // in pixels
  bool logarithmic = false;

  double position(double value) const {
    if (logarithmic) {
      value = value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
    }
    return from + (value - low) / (high - low) * (to - from);
  }
};

/// Where a logarithmic axis ends that holds a value: the logarithm of the next 1, 2 or 5 of a decade below it, or above
/// it.
double round_logarithm(double value, bool above) {
  const double exact = std::log10(value);
  const double decade = std::floor(exact + 1e-9);
  double below = decade;
  for (const double lead : {1.0, 2.0, 5.0, 10.0}) {
    const double at = decade + std::log10(lead);
    if (above && at >= exact - 1e-9) return at;
    if (at <= exact + 1e-9) below = at;
  }
  return below;
}

Scale make_scale(const Axis& axis, std::span<const Curve> curves, bool along_x) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Curve& curve : curves) {
    for (const double value : along_x ? curve.x : curve.y) {
      if (std::isfinite(value) && (!axis.logarithmic || value > 0)) {
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
    if (!along_x && curve.style == Curve::Style::bars && !axis.logarithmic) {
      low = std::min(low, 0.0);
    }
  }
  if (!(low <= high)) {
    low = axis.logarithmic ? 0.1 : 0;
    high = 1;
  }
  Scale scale;
  scale.logarithmic = axis.logarithmic;
  if (axis.logarithmic) {
    scale.low = axis.minimum ? std::log10(*axis.minimum) : round_logarithm(low, false);
    scale.high = axis.maximum ? std::log10(*axis.maximum) : round_logarithm(high, true);
  } else {
    const double margin = along_x ? 0 : 0.05 * (high - low);
    scale.low = axis.minimum.value_or(low - margin);
    scale.high = axis.maximum.value_or(high + margin);
  }
  if (!(scale.high > scale.low)) {
    scale.high = scale.low + 1;
  }
  return scale;
}

/// Round values, about one every `apart` pixels (decades on a logarithmic axis).
std::vector<double> ticks_of(const Scale& scale, double apart) {
  std::vector<double> ticks;
  const double count = std::max(2.0, std::abs(scale.to - scale.from) / apart);
  if (scale.logarithmic) {
    const double step = std::max(1.0, std::ceil((scale.high - scale.low) / count));
    const bool has_room = count > 3 * (scale.high - scale.low);  // for 1, 2 and 5 of each decade
    for (double decade = std::floor(scale.low); decade <= scale.high + 1e-9; decade += step) {
      for (const double lead : {1.0, 2.0, 5.0}) {
        const double at = decade + std::log10(lead);
        const bool is_in = at >= scale.low - 1e-9 && at <= scale.high + 1e-9;
        if (is_in && (lead == 1.0 || has_room)) ticks.push_back(lead * std::pow(10.0, decade));
      }
    }
    return ticks;
  }
  const double raw = (scale.high - scale.low) / count;
  const double decade = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / decade;
  const double step = decade * (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10);
  for (double n = std::ceil(scale.low / step); n * step <= scale.high + 1e-9 * step; ++n) {
    ticks.push_back(n * step);
  }
  return ticks;
}

std::string tick_label(const Scale& scale, double value) {
  if (scale.logarithmic && (value < 1e-3 || value > 99999)) return fmt::format("{:.0e}", value);
  return fmt::format("{:.5g}", std::abs(value) < 1e-12 * (scale.high - scale.low) ? 0.0 : value);
}

void draw_curve(Canvas& canvas, const Curve& curve, const Scale& x, const Scale& y) {
  std::vector<Point> points;
  points.reserve(curve.x.size());
  for (std::size_t n = 0; n < std::min(curve.x.size(), curve.y.size()); ++n) {
    points.emplace_back(x.position(curve.x[n]), y.position(curve.y[n]));
  }
  switch (curve.style) {
    case Curve::Style::line:
      canvas.line(points, curve.color, curve.width, curve.dashed);
      break;
    case Curve::Style::points:
      for (const Point& point : points) {
        if (std::isfinite(point.x) && std::isfinite(point.y)) {
          canvas.disc(point, curve.width, curve.color);
        }
      }
      break;
    case Curve::Style::bars:
      for (std::size_t n = 0; n + 1 < points.size(); ++n) {
        if (std::isfinite(points[n].y)) {
          canvas.rectangle({points[n].x, points[n].y},
                           {std::max(1.0, points[n + 1].x - points[n].x - 1), y.from - points[n].y}, curve.color);
        }
      }
      break;
  }
}

/// In the title's line, from the right: nothing of the curves is hidden.
/// What does not fit beside the title is left out: the marks name it.
void draw_legend(Canvas& canvas, const Chart& chart, double left, double right, double baseline) {
  for (auto curve = chart.curves.rbegin(); curve != chart.curves.rend(); ++curve) {
    if (curve->label.empty()) {
      continue;
    }
    if (right - canvas.text_width(curve->label, 12) - 26 < left) return;
    canvas.text({right, baseline}, curve->label, 12, colors::black, Anchor::right);
    right -= canvas.text_width(curve->label, 12) + 6;
    if (curve->style == Curve::Style::points) {
      canvas.disc({right - 8, baseline - 4}, 4, curve->color);
    } else {
      canvas.line(std::array{Point{right - 20, baseline - 4}, Point{right, baseline - 4}}, curve->color, 3,
                  curve->dashed);
    }
    right -= 38;
  }
}

void draw_bands(Canvas& canvas, const Chart& chart, const Scale& x, const Scale& y, double text) {
  for (const Band& band : chart.bands) {
    const double from = std::max(x.position(band.from), x.from), to = std::min(x.position(band.to), x.to);
    if (!(to > from)) continue;
    canvas.rectangle({from, y.to}, {to - from, y.from - y.to}, band.color);
    if (canvas.text_width(band.label, text - 2) < to - from - 4) {
      canvas.text({(from + to) / 2, y.from - 4}, band.label, text - 2, colors::gray, Anchor::center);
    }
  }
}

void draw_panel(Canvas& canvas, const Chart& chart, double top, double height, const ChartStyle& style) {
  const Point corner{style.left, top + style.top};
  const Point size{canvas.width() - corner.x - style.right, height - style.top - style.bottom};
  const double small = style.text - 1;
  Scale x = make_scale(chart.x, chart.curves, true);
  Scale y = make_scale(chart.y, chart.curves, false);
  x.from = corner.x;
  x.to = corner.x + size.x;
  y.from = corner.y + size.y;
  y.to = corner.y;

  if (style.titled) canvas.text({corner.x, corner.y - 12}, chart.title, style.text + 2);
  draw_bands(canvas, chart, x, y, style.text);
  for (const double tick : chart.x.numbered ? ticks_of(x, 7 * style.text) : std::vector<double>()) {
    const double at = x.position(tick);
    canvas.line(std::array{Point{at, y.from}, Point{at, y.to}}, colors::light, 1);
    canvas.text({at, y.from + style.text + 4}, tick_label(x, tick), small, colors::black, Anchor::center);
  }
  for (const double tick : ticks_of(y, 3.5 * style.text)) {
    const double at = y.position(tick);
    canvas.line(std::array{Point{x.from, at}, Point{x.to, at}}, colors::light, 1);
    canvas.text({x.from - 5, at + 4}, tick_label(y, tick), small, colors::black, Anchor::right);
  }
  canvas.clip(corner, size);
  for (const Curve& curve : chart.curves) {
    draw_curve(canvas, curve, x, y);
  }
  double label_height = corner.y + style.text + 1;
  for (const Mark& mark : chart.marks) {
    const double at = mark.vertical ? x.position(mark.at) : y.position(mark.at);
    if (mark.vertical) {
      canvas.line(std::array{Point{at, y.from}, Point{at, y.to}}, mark.color, 1.2, true);
      const bool fits = at + 4 + canvas.text_width(mark.label, small) < x.to;
      canvas.text({fits ? at + 4 : at - 4, label_height}, mark.label, small, mark.color,
                  fits ? Anchor::left : Anchor::right);
      label_height += style.text + 2;
    } else {
      canvas.line(std::array{Point{x.from, at}, Point{x.to, at}}, mark.color, 1.2, true);
      canvas.text({x.from + 6, at - 4}, mark.label, small, mark.color);
    }
  }
  canvas.unclip();
  if (style.titled) {
    const double title = canvas.text_width(chart.title, style.text + 2);
    draw_legend(canvas, chart, corner.x + title + 12, corner.x + size.x, corner.y - 12);
  }
  canvas.rectangle(corner, size, colors::black, false);
  canvas.text({corner.x + size.x / 2, top + height - 0.8 * style.text}, chart.x.label, style.text, colors::black,
              Anchor::center);
  canvas.text({1.3 * style.text, corner.y + size.y / 2}, chart.y.label, style.text, colors::black, Anchor::center,
              true);
}

}  // namespace

void draw(Canvas& canvas, std::span<const Chart> panels, const ChartStyle& style) {
  const double height = static_cast<double>(canvas.height()) / static_cast<double>(panels.size());
  for (std::size_t n = 0; n < panels.size(); ++n) {
    draw_panel(canvas, panels[n], static_cast<double>(n) * height, height, style);
  }
}

void write_png(std::span<const Chart> panels, const std::filesystem::path& file, int width, int height) {
  Canvas canvas(width, height * static_cast<int>(panels.size()), colors::white);
  draw(canvas, panels);
  canvas.write_png(file);
}

void write_png(const Chart& chart, const std::filesystem::path& file, int width, int height) {
  write_png(std::span(&chart, 1), file, width, height);
}

}  // namespace palpate::plugin
