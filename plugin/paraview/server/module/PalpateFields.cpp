#include "plugin/paraview/server/module/PalpateFields.h"

#include <vtkDataObject.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include "plugin/paraview/server/module/image_fields.h"
#include "plugin/paraview/server/module/pieces.h"
#include "plugin/paraview/server/module/scan_of_image.h"

using namespace palpate;
using Pipeline = vtkStreamingDemandDrivenPipeline;

vtkStandardNewMacro(PalpateFields);

void PalpateFields::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "Scale: " << scale_mm_ << " mm\n" << indent << "Mode: " << mode_ << "\n";
}

void PalpateFields::SetMakeGradient(bool on) {
  make_gradient_ = on;
  Modified();
}

void PalpateFields::SetMakeMagnitude(bool on) {
  make_magnitude_ = on;
  Modified();
}

void PalpateFields::SetMakeFeltStrength(bool on) {
  make_felt_ = on;
  Modified();
}

void PalpateFields::SetScale(double scale_mm) {
  scale_mm_ = scale_mm;
  Modified();
}

void PalpateFields::SetScene(const char* scene) {
  scene_ = scene ? scene : "";
  Modified();
}

void PalpateFields::SetMode(const char* name) {
  mode_ = name ? name : "";
  Modified();
}

int PalpateFields::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

// The superclass would announce the input's scalars only.
int PalpateFields::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) {
  return 1;
}

int PalpateFields::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output) {
  vtkInformation& image = *input[0]->GetInformationObject(0);
  std::array<int, 6> whole{};
  std::array<int, 6> wanted{};
  image.Get(Pipeline::WHOLE_EXTENT(), whole.data());
  output->GetInformationObject(0)->Get(Pipeline::UPDATE_EXTENT(), wanted.data());
  // A part needs its neighbors' voxels as far as the gradient reaches.
  const double scale = scale_mm_ > 0 ? scale_mm_ : plugin::gradient_scale_of(scene_);
  const int reach = plugin::furthest_reach(image.Get(vtkDataObject::SPACING()), scale);
  for (std::size_t axis = 0; axis < 3 && wanted[0] <= wanted[1]; ++axis) {
    wanted[2 * axis] = std::max(wanted[2 * axis] - reach, whole[2 * axis]);
    wanted[2 * axis + 1] = std::min(wanted[2 * axis + 1] + reach, whole[2 * axis + 1]);
  }
  image.Set(Pipeline::UPDATE_EXTENT(), wanted.data(), 6);
  // If there are several ranks, each is asked for a piece. Its source computes the extent from the piece and its
  // ghosts.
  vtkInformation& asked = *output->GetInformationObject(0);
  if (plugin::pieces_of(asked) > 1) plugin::ask_for_ghosts(image, asked, reach);
  return 1;
}

namespace {

/// The requested part of the image: a rank's own part, or the extent.
std::array<int, 6> own_part(vtkImageData& image, vtkInformation& asked) {
  if (plugin::pieces_of(asked) > 1) return plugin::own_extent(image, plugin::ghosts_of(asked));
  std::array<int, 6> there{};
  std::array<int, 6> part{};
  image.GetExtent(there.data());
  asked.Get(Pipeline::UPDATE_EXTENT(), part.data());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    part[2 * axis] = std::max(part[2 * axis], there[2 * axis]);
    part[2 * axis + 1] = std::min(part[2 * axis + 1], there[2 * axis + 1]);
  }
  return part;
}

}  // namespace

int PalpateFields::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output) {
  vtkImageData& image = *vtkImageData::GetData(input[0]);
  vtkImageData& result = *vtkImageData::GetData(output);
  result.ShallowCopy(&image);
  if (image.GetNumberOfPoints() == 0) return 1;
  try {
    // The neighbors' voxels are read, and not passed on.
    vtkInformation& asked = *output->GetInformationObject(0);
    const std::array<int, 6> part = own_part(image, asked);
    // The marks of ghost voxels are not passed on either. A rank's own part has none, and they take 2 bytes a voxel.
    if (plugin::pieces_of(asked) > 1 && plugin::ghosts_of(asked) == 0) plugin::remove_ghost_marks(result);
    plugin::cut_to(part, result);
    const auto volume = plugin::scan_of(image);
    plugin::FieldChoice choice{.gradient = make_gradient_,
                               .magnitude = make_magnitude_,
                               .felt = make_felt_,
                               .scene = plugin::scene_of(scene_, *volume),
                               .mode = mode_};
    if (scale_mm_ > 0) choice.scene.gradient_scale_mm = scale_mm_;
    for (const auto& array : plugin::fields_of(result, volume, choice, [this](double done) {
           UpdateProgress(done);
           return GetAbortExecute() == 0;
         })) {
      result.GetPointData()->AddArray(array);
    }
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  // The array made last is the active one.
  if (make_felt_ || make_magnitude_) {
    result.GetPointData()->SetActiveScalars(make_felt_ ? plugin::felt_name : plugin::magnitude_name);
  }
  return 1;
}
