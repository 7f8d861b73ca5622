#include "plugin/paraview/server/module/PalpateForceProfile.h"

#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkStringArray.h>
#include <vtkTable.h>

#include <exception>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "plugin/paraview/server/module/scan_of_image.h"
#include "plugin/report/summary.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/stroke.h"

using namespace palpate;

namespace {

using Stroke = std::vector<plugin::StrokePoint>;

void add_column(vtkTable& table, const char* name, const Stroke& stroke,
                const std::function<double(const plugin::StrokePoint&)>& value) {
  vtkNew<vtkDoubleArray> column;
  column->SetName(name);
  column->SetNumberOfTuples(static_cast<vtkIdType>(stroke.size()));
  for (std::size_t n = 0; n < stroke.size(); ++n) column->SetValue(static_cast<vtkIdType>(n), value(stroke[n]));
  table.AddColumn(column);
}

void add_vectors(vtkTable& table, const char* name, const Stroke& stroke, glm::dvec3 plugin::StrokePoint::*member) {
  vtkNew<vtkDoubleArray> column;
  column->SetName(name);
  column->SetNumberOfComponents(3);
  column->SetNumberOfTuples(static_cast<vtkIdType>(stroke.size()));
  for (std::size_t n = 0; n < stroke.size(); ++n) column->SetTuple(static_cast<vtkIdType>(n), &(stroke[n].*member).x);
  table.AddColumn(column);
}

void fill(vtkTable& table, const Stroke& stroke, const modes::Scene& scene) {
  if (stroke.empty()) return;
  const glm::dvec3 start = stroke.front().position_mm;
  add_column(table, "Depth (mm)", stroke, [&](const auto& p) { return glm::distance(p.position_mm, start); });
  add_column(table, "Force (N)", stroke, [](const auto& p) { return glm::length(p.force_n); });
  add_column(table, "Value at proxy", stroke, [](const auto& p) { return p.value; });
  add_column(table, "Error bound (m)", stroke, [](const auto& p) { return p.error_bound_m; });
  add_vectors(table, "Probe (mm)", stroke, &plugin::StrokePoint::position_mm);
  add_vectors(table, "Proxy (mm)", stroke, &plugin::StrokePoint::proxy_mm);
  add_vectors(table, "Force vector (N)", stroke, &plugin::StrokePoint::force_n);
  vtkNew<vtkStringArray> boundaries;
  boundaries->SetName("Boundary");
  for (const auto& point : stroke) {
    boundaries->InsertNextValue(point.boundary ? plugin::display_name(scene, *point.boundary) : "");
  }
  table.AddColumn(boundaries);
}

}  // namespace

vtkStandardNewMacro(PalpateForceProfile);

void PalpateForceProfile::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "Speed: " << speed_ << " mm/s\n";
}

void PalpateForceProfile::SetPoint1(double x, double y, double z) {
  from_ = {x, y, z};
  Modified();
}

void PalpateForceProfile::SetPoint2(double x, double y, double z) {
  to_ = {x, y, z};
  Modified();
}

void PalpateForceProfile::SetSpeed(double speed) {
  speed_ = speed;
  Modified();
}

void PalpateForceProfile::SetScene(const char* scene) {
  scene_ = scene ? scene : "";
  Modified();
}

int PalpateForceProfile::FillInputPortInformation(int, vtkInformation* info) {
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  return 1;
}

int PalpateForceProfile::RequestUpdateExtent(vtkInformation*, vtkInformationVector** input,
                                             vtkInformationVector* output) {
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation& image = *input[0]->GetInformationObject(0);
  vtkInformation& table = *output->GetInformationObject(0);
  // A stroke crosses the borders of parts: the first rank works on the whole scan, the others on as good as nothing.
  const bool first = !table.Has(Pipeline::UPDATE_PIECE_NUMBER()) || table.Get(Pipeline::UPDATE_PIECE_NUMBER()) == 0;
  std::array<int, 6> extent{};
  image.Get(Pipeline::WHOLE_EXTENT(), extent.data());
  if (!first) extent = {0, -1, 0, -1, 0, -1};
  image.Set(Pipeline::UPDATE_EXTENT(), extent.data(), 6);
  return 1;
}

int PalpateForceProfile::RequestData(vtkInformation*, vtkInformationVector** input, vtkInformationVector* output) {
  vtkImageData& image = *vtkImageData::GetData(input[0]);
  if (image.GetNumberOfPoints() == 0) return 1;
  try {
    const auto volume = plugin::scan_of(image);
    const modes::Scene scene = plugin::scene_of(scene_, *volume);
    constexpr glm::dvec3 any_reach(0.1);  // only a scene that fits itself to a device depends on it
    const plugin::PreparedScene felt = plugin::prepare(scene, volume, any_reach);
    const auto stroke =
        plugin::run_stroke(*felt.plan, *felt.source, {from_[0], from_[1], from_[2]}, {to_[0], to_[1], to_[2]}, speed_);
    fill(*vtkTable::GetData(output), stroke, scene);
  } catch (const std::exception& error) {
    vtkErrorMacro(<< error.what());
    return 0;
  }
  return 1;
}
