#include "plugin/paraview/server/module/image_fields.h"

#include <vtkFloatArray.h>
#include <vtkImageData.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "io/parallel.h"
#include "modes/scene/felt_strength.h"
#include "modes/types/mode_type.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/server/module/scan_of_image.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

using io::FieldSet;

constexpr FieldSet from_gradients = FieldSet::gradient | FieldSet::low_high;

/// The modes whose strengths are added up.
std::vector<const modes::ActiveMode*> felt_modes(const modes::Plan& plan, const FieldChoice& choice) {
  if (!choice.felt) return {};
  if (choice.mode.empty()) return modes::holding_modes(plan);
  const auto& all = choice.scene.modes;
  if (std::ranges::none_of(all, [&](const modes::Mode& mode) { return mode.name == choice.mode; })) {
    throw InvalidInput(say("scene-has-no-mode-named", choice.mode));
  }
  std::vector<const modes::ActiveMode*> felt;
  for (const modes::ActiveMode& mode : plan.modes) {
    if (all[mode.scene_index].name == choice.mode) felt.push_back(&mode);
  }
  return felt;
}

vtkSmartPointer<vtkFloatArray> make_array(const char* name, int components, vtkIdType points) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(points);
  return array;
}

/// The arrays in the making; a point is written by one thread.
class Fields {
 public:
  Fields(const FieldChoice& choice, const io::Volume& volume, double scale_mm,
         std::vector<const modes::ActiveMode*> felt, vtkIdType points)
      : felt_modes_(std::move(felt)), strength_(volume, felt_modes_, choice.scene.sampling.value, scale_mm) {
    if (choice.gradient) gradient_ = make_array(gradient_name, 3, points);
    if (choice.magnitude) magnitude_ = make_array(magnitude_name, 1, points);
    if (choice.felt) felt_ = make_array(felt_name, 1, points);
  }

  void put(vtkIdType point, const io::Sample& sample) const {
    if (gradient_) {
      const glm::vec3 gradient(sample.gradient);
      gradient_->SetTypedTuple(point, &gradient.x);
    }
    if (magnitude_) magnitude_->SetValue(point, static_cast<float>(glm::length(sample.gradient)));
    if (!felt_) return;
    double strength = 0;
    for (const modes::ActiveMode* mode : felt_modes_) strength += sample.inside ? mode->strength(sample) : 0;
    felt_->SetValue(point, static_cast<float>(strength));
  }

  /// The same of voxels along a row.
  void put_row(vtkIdType point, const io::Volume& volume, const glm::ivec3& first,
               std::span<const glm::vec3> gradients) const {
    const std::size_t count = gradients.size();
    const bool may_be_no_number = std::holds_alternative<std::vector<float>>(volume.voxels);
    for (std::size_t n = 0; (gradient_ || magnitude_) && n < count; ++n) {
      const glm::ivec3 voxel = first + glm::ivec3(static_cast<int>(n), 0, 0);
      const bool inside = !volume.is_padding(voxel.x, voxel.y, voxel.z) &&
                          (!may_be_no_number || std::isfinite(volume.value_at(voxel.x, voxel.y, voxel.z)));
      const glm::vec3 gradient = inside ? gradients[n] : glm::vec3(0);
      const vtkIdType at = point + static_cast<vtkIdType>(n);
      if (gradient_) gradient_->SetTypedTuple(at, &gradient.x);
      if (magnitude_) magnitude_->SetValue(at, static_cast<float>(glm::length(glm::dvec3(gradient))));
    }
    if (!felt_) return;
    strength_.at_row(first, gradients, {felt_->GetPointer(point), count});
  }

  std::vector<vtkSmartPointer<vtkFloatArray>> arrays() const {
    std::vector<vtkSmartPointer<vtkFloatArray>> made;
    for (const auto& array : {gradient_, magnitude_, felt_}) {
      if (array) made.push_back(array);
    }
    return made;
  }

 private:
  std::vector<const modes::ActiveMode*> felt_modes_;
  modes::FeltStrength strength_;
  vtkSmartPointer<vtkFloatArray> gradient_;
  vtkSmartPointer<vtkFloatArray> magnitude_;
  vtkSmartPointer<vtkFloatArray> felt_;
};

/// A box of points in blocks whose sums stay in a second-level cache, as GradientKernel has its own.
std::vector<io::Block> blocks_of(const glm::ivec3& size) {
  constexpr glm::ivec3 longest(512, 24, 64);
  std::vector<io::Block> blocks;
  glm::ivec3 at(0);
  for (at.z = 0; at.z < size.z; at.z += longest.z) {
    for (at.y = 0; at.y < size.y; at.y += longest.y) {
      for (at.x = 0; at.x < size.x; at.x += longest.x) blocks.push_back({at, glm::min(longest, size - at)});
    }
  }
  return blocks;
}

void fill_from_voxels(const io::Volume& volume, const io::GradientKernel* kernel, const glm::ivec3& first,
                      const glm::ivec3& size, const io::Progress& progress, const Fields& fields) {
  const std::vector<io::Block> blocks = blocks_of(size);
  const auto fill = [&](std::size_t one) {
    const io::Block& block = blocks[one];
    std::vector<glm::vec3> gradients(block.voxels());
    if (kernel) kernel->at_block({first + block.first, block.size}, gradients);
    const auto count = static_cast<std::size_t>(block.size.x);
    std::size_t n = 0;
    const glm::ivec3 end = block.first + block.size;
    for (int k = block.first.z; k < end.z; ++k) {
      for (int j = block.first.y; j < end.y; ++j, n += count) {
        const vtkIdType point = (vtkIdType{k} * size.y + j) * size.x + block.first.x;
        fields.put_row(point, volume, first + glm::ivec3(block.first.x, j, k), std::span(gradients).subspan(n, count));
      }
    }
  };
  io::internal::parallel_for(blocks.size(), fill, progress, 0);
}

void fill_from_samples(vtkImageData& image, const io::FieldSource& source, FieldSet wanted,
                       const io::Progress& progress, const Fields& fields) {
  const int* const size = image.GetDimensions();
  const vtkIdType slice = vtkIdType{size[0]} * size[1];
  const auto fill = [&](std::size_t k) {
    const auto begin = static_cast<vtkIdType>(k) * slice;
    for (vtkIdType point = begin; point < begin + slice; ++point) {
      glm::dvec3 position;
      image.GetPoint(point, &position.x);
      fields.put(point, source.sample(position, wanted));
    }
  };
  io::internal::parallel_for(static_cast<std::size_t>(size[2]), fill, progress, 0);
}

}  // namespace

std::vector<vtkSmartPointer<vtkFloatArray>> fields_of(vtkImageData& image,
                                                      const std::shared_ptr<const io::Volume>& scan,
                                                      const FieldChoice& choice, const io::Progress& progress) {
  const std::shared_ptr<const io::Volume> volume = io::filtered(scan, choice.scene.filter, progress);
  const double scale = choice.scene.gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry));
  const auto plan = plan_for(choice.scene, *volume, glm::dvec3(0.1));
  const auto modes = felt_modes(*plan, choice);
  FieldSet wanted = FieldSet::value;
  for (const modes::ActiveMode* mode : modes) wanted = wanted | mode->strength.reads();
  if (choice.gradient || choice.magnitude) wanted = wanted | FieldSet::gradient;

  const Fields fields(choice, *volume, scale, modes, image.GetNumberOfPoints());
  const VoxelBlock block = block_of(image, *volume);
  const bool of_voxels = block.aligned && io::contains(FieldSet::value | from_gradients, wanted) &&
                         choice.scene.sampling.gradient == io::GradientMethod::gaussian;
  if (of_voxels) {
    std::optional<io::GradientKernel> kernel;
    if ((wanted & from_gradients) != FieldSet::none) kernel.emplace(volume, scale);
    glm::ivec3 size;
    image.GetDimensions(&size.x);
    const glm::ivec3 first(block.first[0], block.first[1], block.first[2]);
    fill_from_voxels(*volume, kernel ? &*kernel : nullptr, first, size, progress, fields);
  } else {
    const io::VolumeFields source(volume, wanted, scale, modes::field_options(choice.scene.sampling));
    fill_from_samples(image, source, wanted, progress, fields);
  }
  return fields.arrays();
}

int furthest_reach(const double* spacing_mm, double scale_mm) {
  constexpr double cut_off = 3.2;     // sigma: io/gradient.h
  constexpr double leaning = 0.5;     // slices under a gantry tilt of 60 degrees are half their step apart
  constexpr double most_default = 2;  // default_gradient_scale_mm() is at most this many voxels, or 1.5 mm
  const auto [least, most] = std::minmax({spacing_mm[0], spacing_mm[1], spacing_mm[2]});
  const double scale = scale_mm > 0 ? scale_mm : std::max(1.5, most_default * most);
  return static_cast<int>(std::ceil(cut_off * scale / (leaning * least))) + 2;
}

}  // namespace palpate::plugin
