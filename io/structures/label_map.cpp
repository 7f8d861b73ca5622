#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "io/errors.h"
#include "io/interchange/voxel_bytes.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/mask_source.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

constexpr double most_label = 65535;

struct Box {
  glm::ivec3 low{std::numeric_limits<int>::max()}, high{-1};
};

class LabelMapSource final : public MaskSource {
 public:
  LabelMapSource(VoxelFile image, std::map<int, Box> boxes) : image_(std::move(image)), boxes_(std::move(boxes)) {}

  StructureBox box(int number, const RigidMotion& motion) const override {
    const auto found = boxes_.find(number);
    if (found == boxes_.end()) throw DicomError(say("no-voxel-inside"));
    StructureBox around{Vec3(std::numeric_limits<double>::infinity()), Vec3(-std::numeric_limits<double>::infinity())};
    for (int k = found->second.low.z; k <= found->second.high.z; ++k) {  // slices may be sheared against each other
      for (int corner = 0; corner < 4; ++corner) {
        const glm::ivec3 voxel((corner % 2 == 0 ? found->second.low : found->second.high).x,
                               (corner / 2 == 0 ? found->second.low : found->second.high).y, k);
        const Vec3 at = motion(image_.geometry.to_patient(Vec3(voxel)));
        around.low_mm = glm::min(around.low_mm, at);
        around.high_mm = glm::max(around.high_mm, at);
      }
    }
    return around;
  }

 private:
  Mask mask_of(int number) const override {
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
    const auto layers = static_cast<std::size_t>(image_.layers);
    const std::size_t layer = image_.layers > 1 ? static_cast<std::size_t>(number / label_number(1, 0)) : 0;
    const int value = number - label_number(static_cast<int>(layer), 0);
    int left = mask.size.z;
    read_slices(image_, [&](int k, std::span<const double> values) {
      if (k < low.z || k > high.z) return true;
      for (int j = low.y; j <= high.y; ++j) {
        for (int i = low.x; i <= high.x; ++i) {
          const std::size_t voxel = static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i);
          if (values[voxel * layers + layer] == value) {
            mask.occupancy[mask.offset(i - low.x, j - low.y, k - low.z)] = Mask::full;
          }
        }
      }
      return --left > 0;
    });
    return mask;
  }

  VoxelFile image_;
  std::map<int, Box> boxes_;
};

/// The box of each label, by its number; nothing if the values are those of an image and not labels.
std::optional<std::map<int, Box>> boxes_in(const VoxelFile& image) {
  constexpr std::size_t most_labels = 4096;
  std::map<int, Box> boxes;
  std::uint64_t inside = 0,
                changes = 0;  // voxels with a label, and those of them that the one before them differs from
  bool is_map = true;
  // Labels come in stretches; an image's values differ from voxel to voxel.
  constexpr std::uint64_t least_stretch = 3, enough = 1'000'000;
  const auto looks_like_an_image = [&] {
    return !image.said_to_be_labels && changes * least_stretch > inside && boxes.size() > 2;
  };
  const int columns = image.geometry.dimensions.x;
  const auto layers = static_cast<std::size_t>(image.layers);
  const auto look_at = [&](int k, std::size_t layer, std::span<const double> values) {
    double before = 0;
    Box* box = nullptr;  // of the label before
    for (std::size_t n = 0; n < values.size() / layers; ++n) {
      const double value = values[n * layers + layer];
      const bool same = value == before;
      if (value == 0) {
        before = 0;
        continue;
      }
      if (!same) {
        if (!(value > 0 && value <= most_label) || value != std::floor(value)) return is_map = false;
        box = &boxes[label_number(static_cast<int>(layer), static_cast<int>(value))];
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
    if (inside > enough && looks_like_an_image()) is_map = false;
    return is_map;
  };
  read_slices(image, [&](int k, std::span<const double> values) {
    for (std::size_t layer = 0; layer < layers && is_map; ++layer) look_at(k, layer, values);
    return is_map;
  });
  if (looks_like_an_image()) is_map = false;
  return is_map ? std::optional(boxes) : std::nullopt;
}

/// "liver" for "liver.nii.gz": the organ's name in a folder with one mask a file.
std::string organ_of(std::filesystem::path file) {
  file = file.filename();
  std::vector<std::string> endings = label_format_endings();
  endings.insert(endings.begin(), ".gz");
  endings.emplace_back(".seg");
  for (const std::string& ending : endings) {
    if (file.extension() == ending && !file.stem().empty()) file = file.stem();
  }
  return file.string();
}

}  // namespace

bool is_label_map(const VoxelFile& file) {
  const bool may_be = file.frames() == 1 && file.beside == VoxelFile::Beside::labels;
  if (!may_be || file.axes != std::array{0, 1, 2}) return false;
  return boxes_in(file).has_value();
}

std::vector<Structure> structures_of_label_map(const std::filesystem::path& path) {
  auto image = open_voxel_file(path, path);
  if (!image) return {};
  if (image->beside == VoxelFile::Beside::colors) {
    throw DicomError(say("voxels-have-several-values", image->layers));
  }
  if (image->frames() > 1) throw DicomError(say("labels-in-several-volumes"));
  check_size(*image);
  if (image->axes != std::array{0, 1, 2}) throw DicomError(say("labels-in-another-order"));
  const auto found = boxes_in(*image);
  if (!found) return {};
  const std::map<int, Box>& boxes = *found;
  const std::map<int, LabelName> names = image->names;
  const std::vector<Text> remarks = image->remarks;
  const std::filesystem::path voxels_at = image->voxels_at;
  const auto source = std::make_shared<const LabelMapSource>(std::move(*image), boxes);
  std::set<int> numbers;
  for (const auto& [number, box] : boxes) numbers.insert(number);
  // Labels that the file names without any voxel are listed, too, but cannot be felt; so is an empty mask.
  for (const auto& [number, name] : names) {
    if (number > 0) numbers.insert(number);  // 0 is the background
  }
  if (numbers.empty()) numbers.insert(1);
  const bool is_one_mask = names.empty() && numbers.size() == 1;
  std::vector<Structure> structures;
  for (const int number : numbers) {
    Structure structure;
    if (!boxes.contains(number)) structure.unfit = say("no-voxel-inside");
    structure.file = path;
    if (voxels_at != path) structure.voxels_file = voxels_at;
    structure.kind = StructureKind::label_map;
    structure.number = number;
    const auto named = names.find(number);
    structure.name = is_one_mask                                          ? organ_of(path)
                     : named == names.end() || named->second.name.empty() ? "label " + std::to_string(number)
                                                                          : named->second.name;
    structure.color = named == names.end() ? std::string() : named->second.color;
    structure.warnings.push_back(say("label-map-names-no-scan"));
    structure.warnings.insert(structure.warnings.end(), remarks.begin(), remarks.end());
    structure.source = source;
    structures.push_back(std::move(structure));
  }
  return structures;
}

}  // namespace palpate::io
