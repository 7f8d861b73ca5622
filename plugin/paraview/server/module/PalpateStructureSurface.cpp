#include "plugin/paraview/server/module/PalpateStructureSurface.h"

#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkObjectFactory.h>
#include <vtkPolyData.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include <exception>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "io/bounding_box.h"
#include "plugin/paraview/common/structure_shapes.h"
#include "plugin/paraview/server/module/scan_of_image.h"
#include "plugin/structures/scene_structures.h"

using namespace palpate;

vtkStandardNewMacro(PalpateStructureSurface);

void PalpateStructureSurface::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "Segment: " << segment_ << "\n" << indent << "SegmentNumber: " << segment_number_ << "\n";
}

void PalpateStructureSurface::SetFileName(const char* name) {
  file_ = name ? name : "";
  Modified();
}

void PalpateStructureSurface::SetSegment(const char* name) {
  segment_ = name ? name : "";
  Modified();
}

void PalpateStructureSurface::SetSegmentNumber(int number) {
  segment_number_ = number;
  Modified();
}

int PalpateStructureSurface::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

namespace {

/// The distance as a session has it whose scene names this structure.
plugin::LoadedStructure load(const modes::SceneStructure& structure, const io::Volume& scan) {
  modes::Scene scene;
  scene.structures = {structure};
  modes::Plan plan;
  plan.structures = {0};
  return plugin::load_structures(scene, plan, scan, {}).front();
}

/// A box around the surface, within the scan's and a little around it.
std::pair<glm::dvec3, glm::dvec3> box_of(const io::DistanceField& distance, const io::Box& scan) {
  constexpr double step_mm = 4;
  constexpr double around_mm = 3;
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (double z = scan.low.z; z < scan.high.z + step_mm; z += step_mm) {
    for (double y = scan.low.y; y < scan.high.y + step_mm; y += step_mm) {
      for (double x = scan.low.x; x < scan.high.x + step_mm; x += step_mm) {
        const glm::dvec3 node(x, y, z);
        const double mm = distance.sample(node).mm;
        if (mm < -step_mm) continue;  // farther than half a cell's diagonal: nothing of it is in the cells around
        low = glm::min(low, node);
        high = glm::max(high, node);
      }
    }
  }
  return {glm::max(low - step_mm, scan.low - around_mm), glm::min(high + step_mm, scan.high + around_mm)};
}

}  // namespace

int PalpateStructureSurface::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output) {
  vtkImageData& image = *vtkImageData::GetData(input[0]);
  // It is small, and of the whole scan: one rank of several makes it.
  vtkInformation& asked = *output->GetInformationObject(0);
  const bool first = asked.Get(vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) == 0;
  if (image.GetNumberOfPoints() == 0 || !first) return 1;
  try {
    const auto scan = plugin::scan_of(image);
    modes::SceneStructure structure{.name = segment_, .file = file_, .segment = segment_};
    if (segment_number_ != 0) {
      structure.segment_number = segment_number_;
      structure.name = fmt::format("#{}", segment_number_);
    }
    const plugin::LoadedStructure loaded = load(structure, *scan);
    const auto [low, high] = box_of(*loaded.distance, io::bounding_box(scan->geometry));
    if (low.x < high.x) vtkPolyData::GetData(output)->ShallowCopy(plugin::surface_of(*loaded.distance, low, high));
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  return 1;
}
