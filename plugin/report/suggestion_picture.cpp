#include "plugin/report/suggestion_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "io/bounding_box.h"
#include "io/fields/gradient.h"
#include "io/fields/volume_fields.h"
#include "io/fields/voxel_fields.h"
#include "modes/scene/felt_strength.h"
#include "modes/scene/plan.h"
#include "plugin/report/canvas.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

using Rgb = std::array<unsigned char, 3>;

constexpr double side = 520;  // pixels of a slice and of the histogram
constexpr double margin = 16, heading_room = 40;
constexpr int samples = 260;  // of a slice, along each side
constexpr double legend_row = 22;
constexpr double axis_room = 86;  // left of the histogram

Color color_of_hex(const std::string& hex) {
  const auto part = [&](std::size_t at) {
    return static_cast<double>(std::strtol(hex.substr(at, 2).c_str(), nullptr, 16)) / 255;
  };
  return hex.size() == 7 ? Color{part(1), part(3), part(5)} : colors::gray;
}

/// A slice through the scan's middle, as radiologists hang it.
struct Slice {
  const char* name;
  glm::dvec3 right, down;
};
constexpr std::array slices{Slice{"axial, from the feet", {1, 0, 0}, {0, 1, 0}},
                            Slice{"sagittal, from the left", {0, 1, 0}, {0, 0, -1}}};

/// The content of a slice: the value in gray, and in color the strongest boundary at the nearest voxel.
class Painter {
 public:
  Painter(const modes::Suggestion& suggestion, const std::shared_ptr<const io::Volume>& volume)
      : suggestion_(suggestion),
        volume_(*volume),
        plan_(plan_for(suggestion.scene, *volume, glm::dvec3(0.1))),
        holding_(modes::holding_modes(*plan_)),
        values_(volume, io::FieldSet::value, 0, {.value = io::ValueMethod::trilinear}),
        kernel_(volume, io::default_gradient_scale_mm(volume->geometry)),
        voxels_(*volume, suggestion.scene.sampling.value, kernel_.scale_mm()),
        box_(bounding_box(volume->geometry)) {
    const io::Bins& values = suggestion.edges.values;
    low_ = suggestion.typical.empty() ? values.low : std::ranges::min(suggestion.typical);
    // Up to the brightest tissue, with some room above it.
    high_ = suggestion.typical.empty() ? values.high : low_ + 1.15 * (std::ranges::max(suggestion.typical) - low_);
  }

  void paint(const Slice& slice, const Point& corner, Canvas& canvas) const {
    std::vector<Rgb> pixels(static_cast<std::size_t>(samples) * samples);
    for (int row = 0; row < samples; row += tile_side) {
      for (int column = 0; column < samples; column += tile_side) paint_tile(slice, {column, row}, pixels);
    }
    canvas.image(pixels, samples, samples, corner, {side, side});
    canvas.text(corner + Point{0, -8}, slice.name, 14);
  }

 private:
  static constexpr int tile_side = 20;
  static_assert(samples % tile_side == 0);

  struct Pixel {
    std::size_t at = 0;
    glm::ivec3 nearest{0};  ///< voxel
    double gray = 0;
  };

  /// The pixels of a tile share the gradients of a block of voxels.
  void paint_tile(const Slice& slice, const glm::ivec2& first, std::vector<Rgb>& pixels) const {
    const std::vector<Pixel> inside = pixels_inside(slice, first);
    if (inside.empty()) return;
    glm::ivec3 low = inside.front().nearest, high = low;
    for (const Pixel& pixel : inside) {
      low = glm::min(low, pixel.nearest);
      high = glm::max(high, pixel.nearest);
    }
    const io::Block block{low, high - low + 1};
    std::vector<glm::vec3> gradients(block.voxels());
    kernel_.at_block(block, gradients);
    for (const Pixel& pixel : inside) {
      const glm::ivec3 v = pixel.nearest - low;
      pixels[pixel.at] =
          color_of(pixel, gradients[static_cast<std::size_t>((v.z * block.size.y + v.y) * block.size.x + v.x)]);
    }
  }

  std::vector<Pixel> pixels_inside(const Slice& slice, const glm::ivec2& first) const {
    std::vector<Pixel> inside;
    const glm::dvec3 size = box_.high - box_.low;
    const double extent = std::max({size.x, size.y, size.z});
    for (int row = first.y; row < first.y + tile_side; ++row) {
      for (int column = first.x; column < first.x + tile_side; ++column) {
        const glm::dvec2 at = (glm::dvec2(column, row) + 0.5) / static_cast<double>(samples) - 0.5;
        const glm::dvec3 place = 0.5 * (box_.low + box_.high) + extent * (at.x * slice.right + at.y * slice.down);
        const io::Sample sample = values_.sample(place, io::FieldSet::value);
        if (!sample.inside) continue;
        inside.push_back({static_cast<std::size_t>(row) * samples + static_cast<std::size_t>(column),
                          glm::ivec3(glm::round(volume_.geometry.to_index(place))),
                          std::clamp((sample.value - low_) / (high_ - low_), 0.0, 1.0) * 0.75});
      }
    }
    return inside;
  }

  Rgb color_of(const Pixel& pixel, const glm::vec3& gradient) const {
    const auto [felt, strength] = strongest_at(pixel.nearest, gradient);
    const double gray = pixel.gray;
    Color color{gray, gray, gray};
    if (felt != nullptr) {
      const Color own = color_of_hex(felt->color);
      const double part = std::min(1.0, strength);
      color = {gray + part * (own.red - gray), gray + part * (own.green - gray), gray + part * (own.blue - gray)};
    }
    const auto byte = [](double value) { return static_cast<unsigned char>(std::lround(255 * value)); };
    return {byte(color.red), byte(color.green), byte(color.blue)};
  }

  /// Null if none is felt. The two sides are computed only if value and gradient let a mode be felt.
  std::pair<const modes::Mode*, double> strongest_at(const glm::ivec3& voxel, const glm::vec3& gradient) const {
    std::pair<const modes::Mode*, double> strongest{nullptr, 0};
    const auto value = voxels_.value(voxel);
    if (!value) return strongest;
    io::Sample sample{.inside = true, .value = *value, .gradient = gradient};
    const double magnitude = glm::length(sample.gradient);
    bool knows_sides = false;
    for (const modes::ActiveMode* mode : holding_) {
      const auto is_zero = [&](modes::Datum of, double datum) {
        return mode->strength.not_zero(of, {&datum, 1}, 1) == 0;
      };
      if (is_zero(modes::Datum::value, *value) || is_zero(modes::Datum::gradient_magnitude, magnitude)) continue;
      if (!knows_sides) {
        const io::LowHigh sides = voxels_.low_high(voxel, gradient);
        sample.low = sides.low;
        sample.high = sides.high;
        knows_sides = true;
      }
      const double strength = mode->strength(sample);
      if (strength > strongest.second) strongest = {&suggestion_.scene.modes[mode->scene_index], strength};
    }
    return strongest;
  }

  const modes::Suggestion& suggestion_;
  const io::Volume& volume_;
  std::shared_ptr<const modes::Plan> plan_;
  std::vector<const modes::ActiveMode*> holding_;
  io::VolumeFields values_;
  io::GradientKernel kernel_;
  io::VoxelFields voxels_;
  io::Box box_;
  double low_ = 0, high_ = 1;
};

void paint_pairs(const modes::Suggestion& suggestion, const std::string& unit, const Point& corner, Canvas& canvas) {
  const io::LowHighHistogram& edges = suggestion.edges;
  const int bins = edges.values.count;
  constexpr int cells = 192;
  std::vector<double> counts(static_cast<std::size_t>(cells) * cells);
  for (int high = 0; high < bins; ++high) {
    for (int low = 0; low < bins; ++low) {
      counts[static_cast<std::size_t>(cells - 1 - high * cells / bins) * cells +
             static_cast<std::size_t>(low * cells / bins)] += static_cast<double>(edges.at(low, high));
    }
  }
  const double most = std::log1p(*std::max_element(counts.begin(), counts.end()));
  std::vector<unsigned char> gray(counts.size());
  std::transform(counts.begin(), counts.end(), gray.begin(), [&](double count) {
    return static_cast<unsigned char>(255 - std::lround(235 * std::log1p(count) / std::max(most, 1.0)));
  });
  canvas.gray_image(gray, cells, cells, corner, {side, side});
  const auto x_of = [&](double value) {
    return corner.x + side * (value - edges.values.low) / (edges.values.high - edges.values.low);
  };
  const auto y_of = [&](double value) { return corner.y + side - (x_of(value) - corner.x); };
  for (const modes::Tissue& tissue : suggestion.scene.tissues) {
    if (std::isfinite(tissue.high)) {
      canvas.line(std::array{Point{x_of(tissue.high), corner.y}, Point{x_of(tissue.high), corner.y + side}},
                  colors::gray, 1, true);
      canvas.line(std::array{Point{corner.x, y_of(tissue.high)}, Point{corner.x + side, y_of(tissue.high)}},
                  colors::gray, 1, true);
    }
  }
  for (const modes::FoundBoundary& boundary : suggestion.boundaries) {
    const Color color = color_of_hex(suggestion.scene.modes[boundary.mode].color);
    const Point at{x_of(suggestion.typical[boundary.low]), y_of(suggestion.typical[boundary.high])};
    canvas.disc(at, 9, colors::white);
    canvas.disc(at, 7, color);
  }
  // Similar tissues: every other number is a row farther out.
  constexpr double widest = 44, highest = 14;  // pixels of a number
  bool out_x = false, out_y = false;
  for (std::size_t t = 0; t < suggestion.typical.size(); ++t) {
    const std::string number = fmt::format("{:.0f}", suggestion.typical[t]);
    const Point at{x_of(suggestion.typical[t]), y_of(suggestion.typical[t])};
    const double step = t == 0 ? side : at.x - x_of(suggestion.typical[t - 1]);
    out_x = !out_x && step < widest;
    out_y = !out_y && step < highest;
    canvas.text({at.x, corner.y + side + (out_x ? 30 : 16)}, number, 12, colors::black, Anchor::center);
    canvas.text({corner.x - (out_y ? widest : 6), at.y + 4}, number, 12, colors::black, Anchor::right);
  }
  const std::string in_unit = unit.empty() ? "" : " (" + unit + ")";
  canvas.text({corner.x + side / 2, corner.y + side + 50}, "value on the lower side of a boundary" + in_unit, 13,
              colors::black, Anchor::center);
  canvas.text({corner.x - axis_room, corner.y + side / 2}, "value on the higher side" + in_unit, 13, colors::black,
              Anchor::center, true);
  canvas.text(corner + Point{0, -8}, "which pairs of values boundaries lie between", 14);
}

}  // namespace

void write_suggestion_png(const modes::Suggestion& suggestion, const std::shared_ptr<const io::Volume>& volume,
                          const std::filesystem::path& file) {
  const auto rows = static_cast<double>(suggestion.boundaries.size());
  Canvas canvas(static_cast<int>(3 * side + 5 * margin + axis_room),
                static_cast<int>(heading_room + side + 3 * margin + 20 + legend_row * std::max(2.0, rows)),
                colors::white);
  const Painter painter(suggestion, volume);
  Point corner{margin, heading_room};
  for (const Slice& slice : slices) {
    painter.paint(slice, corner, canvas);
    corner.x += side + margin;
  }
  if (!suggestion.edges.counts.empty()) {
    paint_pairs(suggestion, volume->unit, {corner.x + margin + axis_room, heading_room}, canvas);
  }
  double y = heading_room + side + 2 * margin + 8;
  for (const modes::FoundBoundary& boundary : suggestion.boundaries) {
    const modes::Mode& mode = suggestion.scene.modes[boundary.mode];
    canvas.rectangle({margin, y - 12}, {28, 14}, color_of_hex(mode.color));
    canvas.text({margin + 38, y},
                fmt::format("{}: felt at {:.0f}{}{}; {:.0f} % of what lies at boundaries", mode.name, boundary.middle,
                            volume->unit.empty() ? "" : " ", volume->unit, 100 * boundary.share),
                14);
    y += legend_row;
  }
  canvas.write_png(file);
}

}  // namespace palpate::plugin
