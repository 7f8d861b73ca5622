#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>

#include "io/errors.h"
#include "io/messages.h"
#include "io/structures/beyond_slices.h"
#include "io/structures/label_image.h"
#include "io/structures/mask_measures.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

constexpr double most_label = 65535;

struct Box {
  glm::ivec3 low{std::numeric_limits<int>::max()}, high{-1};
};

class LabelMapSource final : public StructureSource {
 public:
  LabelMapSource(LabelImage image, std::map<int, Box> boxes) : image_(std::move(image)), boxes_(std::move(boxes)) {}

  StructureMeasures measure(int number) const override { return measures_of(mask_of(number)); }
  std::shared_ptr<const DistanceField> distance(int number, const DistanceOptions& options) const override {
    Mask mask = mask_of(number);
    measures_of(mask);  // refuses one that is empty
    add_empty_slices(options, mask);
    return distance_of(mask, options);
  }

 private:
  Mask mask_of(int number) const {
    Mask mask;
    mask.geometry = image_.geometry;
    const auto box = boxes_.find(number);
    if (box == boxes_.end()) return mask;
    const glm::ivec3 low = box->second.low, high = box->second.high;
    mask.low = low;
    mask.size = high - low + 1;
    mask.occupancy.assign(static_cast<std::size_t>(mask.size.x) * static_cast<std::size_t>(mask.size.y) *
                              static_cast<std::size_t>(mask.size.z),
                          0);
    const auto columns = static_cast<std::size_t>(image_.geometry.dimensions.x);
    int left = mask.size.z;
    read_slices(image_, [&](int k, std::span<const double> values) {
      if (k < low.z || k > high.z) return true;
      for (int j = low.y; j <= high.y; ++j) {
        for (int i = low.x; i <= high.x; ++i) {
          if (values[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)] == number) {
            mask.occupancy[mask.offset(i - low.x, j - low.y, k - low.z)] = Mask::full;
          }
        }
      }
      return --left > 0;
    });
    return mask;
  }

  LabelImage image_;
  std::map<int, Box> boxes_;
};

/// Where each label lies; nothing where the values are those of an image and no labels.
std::map<int, Box> boxes_in(const LabelImage& image) {
  constexpr std::size_t most_labels = 4096;
  std::map<int, Box> boxes;
  std::uint64_t inside = 0,
                changes = 0;  // voxels with a label, and those of them that the one before them differs from
  bool is_map = true;
  const int columns = image.geometry.dimensions.x;
  read_slices(image, [&](int k, std::span<const double> values) {
    double before = 0;
    Box* box = nullptr;  // of the label before
    for (std::size_t n = 0; n < values.size(); ++n) {
      const double value = values[n];
      const bool same = value == before;
      if (value == 0) {
        before = 0;
        continue;
      }
      if (!same) {
        if (!(value > 0 && value <= most_label) || value != std::floor(value)) return is_map = false;
        box = &boxes[static_cast<int>(value)];
        if (boxes.size() > most_labels) return is_map = false;
        before = value;
        ++changes;
      }
      ++inside;
      const auto at = static_cast<int>(n);
      const glm::ivec3 voxel(at % columns, at / columns, k);
      box->low = glm::min(box->low, voxel);
      box->high = glm::max(box->high, voxel);
    }
    return true;
  });
  // Labels come in stretches; an image's values differ from voxel to voxel.
  constexpr std::uint64_t least_stretch = 3;
  if (!image.said_to_be_labels && changes * least_stretch > inside && boxes.size() > 2) is_map = false;
  return is_map ? boxes : std::map<int, Box>();
}

}  // namespace

std::vector<Structure> structures_of_label_map(const std::filesystem::path& path) {
  auto image = open_nifti(path);
  if (!image) image = open_nrrd(path);
  if (!image) return {};
  const std::map<int, Box> boxes = boxes_in(*image);
  const std::map<int, LabelName> names = image->names;
  const auto source = std::make_shared<const LabelMapSource>(std::move(*image), boxes);
  std::vector<Structure> structures;
  for (const auto& [number, box] : boxes) {
    Structure structure;
    structure.file = path;
    structure.kind = StructureKind::label_map;
    structure.number = number;
    const auto named = names.find(number);
    structure.name =
        named == names.end() || named->second.name.empty() ? "label " + std::to_string(number) : named->second.name;
    structure.color = named == names.end() ? std::string() : named->second.color;
    structure.warnings.push_back(say("label-map-names-no-scan"));
    structure.source = source;
    structures.push_back(std::move(structure));
  }
  return structures;
}

}  // namespace palpate::io
