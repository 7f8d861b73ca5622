#include "plugin/paraview/server/module/scan_of_image.h"

#include <vtkDataArray.h>
#include <vtkDataArrayRange.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"
#include "plugin/app/open_scan.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/common/shared_voxels.h"

namespace palpate::plugin {
namespace {

glm::dvec3 column(vtkMatrix3x3& matrix, int c) {
  return {matrix.GetElement(0, c), matrix.GetElement(1, c), matrix.GetElement(2, c)};
}

glm::dvec3 first_point(vtkImageData& image) {
  glm::dvec3 position;
  image.GetPoint(0, &position.x);
  return position;
}

io::Geometry geometry_of(vtkImageData& image) {
  vtkMatrix3x3& direction = *image.GetDirectionMatrix();
  const double* const spacing = image.GetSpacing();
  io::Geometry geometry;
  image.GetDimensions(&geometry.dimensions.x);
  geometry.direction_i = column(direction, 0);
  geometry.direction_j = column(direction, 1);
  geometry.spacing_i = spacing[0];
  geometry.spacing_j = spacing[1];
  geometry.step = spacing[2] * column(direction, 2);
  for (int k = 0; k < geometry.dimensions.z; ++k) {
    geometry.slice_positions.push_back(first_point(image) + static_cast<double>(k) * geometry.step);
  }
  return geometry;
}

std::string note_of(vtkImageData& image, const char* name) {
  auto* const notes = vtkStringArray::SafeDownCast(image.GetFieldData()->GetAbstractArray(name));
  return notes && notes->GetNumberOfValues() > 0 ? notes->GetValue(0) : "";
}

}  // namespace

std::shared_ptr<const io::Volume> scan_of(vtkImageData& image) {
  vtkDataArray* const scalars = image.GetPointData()->GetScalars();
  if (!scalars || scalars->GetNumberOfTuples() == 0) throw InvalidInput(say("image-has-no-point-scalars"));
  if (auto behind = volume_behind(*scalars)) return behind;
  if (scalars->GetNumberOfComponents() != 1) {
    throw InvalidInput(say("several-components", scalars->GetName()));
  }
  io::Volume volume;
  volume.geometry = geometry_of(image);
  volume.modality = note_of(image, "Modality");
  volume.body_part = note_of(image, "BodyPart");
  volume.unit = std::string(scalars->GetName()) == "HU" ? "HU" : "";
  std::vector<float> values(static_cast<std::size_t>(scalars->GetNumberOfTuples()));
  const auto range = vtk::DataArrayValueRange<1>(scalars);
  std::transform(range.begin(), range.end(), values.begin(), [](auto value) { return static_cast<float>(value); });
  volume.voxels = std::move(values);
  return std::make_shared<const io::Volume>(std::move(volume));
}

VoxelBlock block_of(vtkImageData& image, const io::Volume& volume) {
  const io::Geometry own = geometry_of(image);
  const glm::dvec3 first = volume.geometry.to_index(own.slice_positions.front());
  const glm::dvec3 size(own.dimensions);
  const glm::dvec3 last = volume.geometry.to_index(own.to_patient(size - 1.0));
  constexpr double visible = 1e-3;  // voxels
  const auto near = [](const glm::dvec3& a, const glm::dvec3& b) { return glm::length(a - b) < visible; };
  const glm::dvec3 start = glm::round(first);
  const bool inside = volume.geometry.contains(start) && volume.geometry.contains(start + size - 1.0);
  const bool aligned = volume.geometry.uniform && inside && near(first, start) && near(last, start + size - 1.0);
  return {aligned, {static_cast<int>(start.x), static_cast<int>(start.y), static_cast<int>(start.z)}};
}

double gradient_scale_of(const std::string& text) {
  try {
    return scene_of(text).gradient_scale_mm.value_or(0);
  } catch (const std::invalid_argument&) {
    return 0;  // told when the scene is used
  }
}

modes::Scene scene_of(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text[first] == '{' ? modes::scene_from_json(text, "scene") : modes::load_scene(text);
}

modes::Scene scene_of(const std::string& text, const io::Volume& volume) {
  return text.find_first_not_of(" \t\r\n") == std::string::npos ? scene_for("", volume) : scene_of(text);
}

}  // namespace palpate::plugin
