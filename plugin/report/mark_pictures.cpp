#include "plugin/report/mark_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "io/fields/volume_fields.h"
#include "plugin/report/slice_picture.h"

namespace palpate::plugin {
namespace {

constexpr int width = 512, height = 512;
constexpr double arm_mm = 4;

io::Picture picture_of(const Canvas& canvas, const std::string& description) {
  io::Picture picture{canvas.width(), canvas.height(), {}, description};
  const std::span<const unsigned char> pixels = canvas.pixels();  // blue, green, red, unused
  picture.pixels.reserve(pixels.size() / 4 * 3);
  for (std::size_t n = 0; n + 3 < pixels.size(); n += 4) {
    for (const std::size_t part : {2, 1, 0}) picture.pixels.push_back(pixels[n + part]);
  }
  return picture;
}

}  // namespace

std::vector<io::Picture> pictures_of(const Marks& marks, const std::shared_ptr<const io::Volume>& volume) {
  const io::VolumeFields fields(volume, io::FieldSet::value, 1.0);
  std::vector<io::Picture> pictures;
  pictures.reserve(marks.points.size());
  for (const FeltMark& mark : marks.points) {
    SliceView view;
    view.center_mm = mark.position_mm;
    if (volume->unit == "HU") {
      view.window_level = 100;
      view.window_width = 1400;
    } else {
      const io::Statistics values = io::statistics(*volume);
      view.window_level = 0.5 * (values.minimum + values.maximum);
      view.window_width = std::max(values.maximum - values.minimum, 1e-6);
    }
    const glm::dvec3 across = arm_mm * view.right, along = arm_mm * view.down;
    const std::array tracks{Track{mark.name, {view.center_mm - across, view.center_mm + across}, colors::yellow},
                            Track{mark.boundary.empty() ? "nothing felt" : mark.boundary,
                                  {view.center_mm - along, view.center_mm + along},
                                  colors::yellow}};
    const std::string title = fmt::format("{}: {:.1f}, {:.1f}, {:.1f} mm (LPS)", mark.name, mark.position_mm.x,
                                          mark.position_mm.y, mark.position_mm.z);
    pictures.push_back(picture_of(draw_slice(fields, view, tracks, {}, title, width, height), title));
  }
  return pictures;
}

}  // namespace palpate::plugin
