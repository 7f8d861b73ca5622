#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "io/errors.h"
#include "io/interchange/voxel_bytes.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/structures/mask_source.h"
#include "io/structures/structure_file.h"

namespace palpate::io {
namespace {

constexpr double most_label = 65535;
constexpr double rounding = 1e-4;  // of labels that were scaled
constexpr int no_label = -1;

/// The label of a value: 0 is the background, as are -1 and what is no number. `no_label` if it is none. Any other
/// negative number is one of a scan, unless the user says that these are labels.
int label_of(double value, bool is_named) {
  if (std::isnan(value)) return 0;
  const double whole = std::round(value);
  if (std::abs(value - whole) > rounding) return no_label;
  if (whole < 0) return whole == -1 || is_named ? 0 : no_label;
  return static_cast<int>(std::min(whole, most_label + 1));
}

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
          if (std::abs(values[voxel * layers + layer] - value) <= rounding) {
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

/// The labels of a file, as its slices are read.
class Labels {
 public:
  Labels(const VoxelFile& image, bool is_named)
      : image_(image), is_named_(is_named), below_(image.numbers_of_slice(), 0), here_(below_) {}

  /// Returns whether more is to be read.
  bool take(int k, std::span<const double> values) {
    for (std::size_t n = 0; n < values.size(); ++n) {
      here_[n] = label_of(values[n], is_named_);
      if (here_[n] == no_label) return is_map_ = false;
    }
    for (std::size_t n = 0; n < values.size() && is_map_; ++n) {
      if (here_[n] != 0) look_at(n, k);
    }
    std::swap(below_, here_);
    has_below_ = true;
    constexpr std::uint64_t enough = 1'000'000;
    if (pairs_ > enough && looks_like_an_image()) is_map_ = false;
    return is_map_;
  }
  bool is_map() const { return is_map_ && !looks_like_an_image(); }
  /// Whether a label is above the largest one that is read.
  bool is_too_large() const { return is_map() && too_large_ > 0; }
  const std::map<int, Box>& boxes() const { return boxes_; }

 private:
  void look_at(std::size_t n, int k) {
    const auto layers = static_cast<std::size_t>(image_.layers);
    const auto columns = static_cast<std::size_t>(image_.geometry.dimensions.x);
    const std::size_t voxel = n / layers;
    bool is_beside_background = false;
    const auto compare = [&](bool is_there, const std::vector<int>& labels, std::size_t back) {
      if (!is_there) return;
      ++pairs_;
      const int other = labels[n - back];
      is_beside_background = is_beside_background || other == 0;
      changes_ += other == here_[n] ? 0 : 1;
      touching_ += other == 0 ? 0 : 1;
      differing_ += other == 0 || other == here_[n] ? 0 : 1;
    };
    compare(voxel % columns > 0, here_, layers);
    compare(voxel >= columns, here_, layers * columns);
    compare(has_below_, below_, 0);
    ++labeled_;
    thin_ += is_beside_background ? 1 : 0;
    if (here_[n] > static_cast<int>(most_label)) {
      ++too_large_;
      return;
    }
    const auto layer = static_cast<int>(n % layers);
    if (here_[n] != last_label_ || layer != last_layer_) {
      last_ = &boxes_[label_number(layer, here_[n])];
      last_label_ = here_[n];
      last_layer_ = layer;
      constexpr std::size_t most_labels = 4096;
      if (boxes_.size() > most_labels) is_map_ = false;
    }
    const glm::ivec3 at(static_cast<int>(voxel % columns), static_cast<int>(voxel / columns), k);
    last_->low = glm::min(last_->low, at);
    last_->high = glm::max(last_->high, at);
  }
  /// Labels adjoin themselves along all axes; an image's values differ from voxel to voxel. What the user says are
  /// labels may be as thin as a voxel: then the background lies beside most voxels, and seldom another label.
  bool looks_like_an_image() const {
    if (image_.said_to_be_labels || boxes_.size() <= 2) return false;
    constexpr std::uint64_t least = 3;
    const bool adjoin_themselves = changes_ * least <= pairs_;
    if (adjoin_themselves || !is_named_) return !adjoin_themselves;
    constexpr std::size_t most_thin = 256;  // labels
    return boxes_.size() > most_thin || 2 * thin_ < labeled_ || 2 * differing_ > touching_;
  }

  const VoxelFile& image_;
  bool is_named_;
  std::map<int, Box> boxes_;
  std::vector<int> below_, here_;  // of the slice below and of this one
  bool has_below_ = false, is_map_ = true;
  std::uint64_t pairs_ = 0, changes_ = 0;       // voxels with a label and those before them; and where the two differ
  std::uint64_t touching_ = 0, differing_ = 0;  // the same of pairs that have a label both
  std::uint64_t labeled_ = 0, thin_ = 0;        // voxels with a label; those after the background along an axis
  std::uint64_t too_large_ = 0;
  Box* last_ = nullptr;
  int last_label_ = 0, last_layer_ = -1;
};

Labels labels_in(const VoxelFile& image, bool is_named) {
  Labels labels(image, is_named);
  read_slices(image, [&](int k, std::span<const double> values) { return labels.take(k, values); });
  return labels;
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
  const Labels labels = labels_in(file, false);
  return labels.is_map() && !labels.is_too_large();
}

std::vector<Structure> structures_of_label_map(const std::filesystem::path& path, bool is_named) {
  auto image = open_voxel_file(path, path);
  if (!image) return {};
  if (image->beside == VoxelFile::Beside::colors) {
    throw DicomError(say("voxels-have-several-values", image->layers));
  }
  if (image->frames() > 1) throw DicomError(say("labels-in-several-volumes"));
  check_size(*image);
  if (image->axes != std::array{0, 1, 2}) throw DicomError(say("labels-in-another-order"));
  const Labels labels = labels_in(*image, is_named);
  if (labels.is_too_large()) throw DicomError(say("labels-are-too-large"));
  if (!labels.is_map()) {
    if (is_named) throw DicomError(say("values-are-no-labels"));
    return {};
  }
  const std::map<int, Box> boxes = labels.boxes();
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
