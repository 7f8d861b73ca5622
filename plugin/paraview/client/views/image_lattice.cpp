#include "plugin/paraview/client/views/image_lattice.h"

#include <vtkDataSetAttributes.h>
#include <vtkPVArrayInformation.h>
#include <vtkPVDataInformation.h>
#include <vtkPVDataSetAttributesInformation.h>
#include <vtkSMProperty.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSessionProxyManager.h>
#include <vtkSMSourceProxy.h>

#include <cmath>
#include <stdexcept>

#include "plugin/messages/messages.h"

namespace palpate::plugin {

glm::dvec3 ImageLattice::center() const {
  glm::dvec3 position = origin;
  for (int axis = 0; axis < 3; ++axis) {
    position += 0.5 * (dimensions[axis] - 1) * spacing[axis] * directions[static_cast<std::size_t>(axis)];
  }
  return position;
}

ImageLattice lattice_of(vtkSMSourceProxy& source) {
  source.UpdatePropertyInformation();
  const auto numbers = vtkSMPropertyHelper(&source, "Lattice").GetDoubleArray();
  if (numbers.size() != 18 || numbers[0] < 1) throw Refusal(say("this-series-could-not-be-read"));
  const auto row = [&](std::size_t n) { return glm::dvec3(numbers[3 * n], numbers[3 * n + 1], numbers[3 * n + 2]); };
  ImageLattice lattice;
  lattice.dimensions = glm::ivec3(row(0));
  lattice.spacing = row(1);
  lattice.origin = row(2);
  lattice.directions = {row(3), row(4), row(5)};
  vtkPVDataSetAttributesInformation& points = *source.GetDataInformation(0)->GetPointDataInformation();
  vtkPVArrayInformation* const scalars = points.GetAttributeInformation(vtkDataSetAttributes::SCALARS);
  if (!scalars) throw Refusal(say("this-series-has-no-values"));
  lattice.array = scalars->GetName();
  lattice.counted_from_last = vtkSMPropertyHelper(&source, "CountedFromLast", true).GetAsInt() != 0;
  Values& values = lattice.values;
  const char* const modality = vtkSMPropertyHelper(&source, "Modality").GetAsString();
  values.modality = modality ? modality : "";
  values.hounsfield = lattice.array == "HU";
  values.low = scalars->GetComponentRange(0)[0];
  values.high = scalars->GetComponentRange(0)[1];
  const auto window = vtkSMPropertyHelper(&source, "Window").GetDoubleArray();
  if (window.size() == 2 && window[1] > 0) values.own = Window{window[0], window[1]};
  ValueProbe probe(source);
  values.shares = probe.shares();
  values.speeds = lattice.array == "m/s";
  if (values.hounsfield) values.light_part = probe.light_part();
  return lattice;
}

ValueProbe::ValueProbe(vtkSMSourceProxy& reader) {
  vtkSMSessionProxyManager* const manager = reader.GetSessionProxyManager();
  proxy_ = vtkSmartPointer<vtkSMProxy>::Take(manager->NewProxy("misc", "PalpateValueProbe"));
  if (!proxy_) return;    // a server without this plug-in
  proxy_->PrototypeOn();  // in no state file, no trace and no undo
  vtkSMPropertyHelper(proxy_, "Reader").Set(&reader);
  proxy_->UpdateVTKObjects();
}

std::optional<double> ValueProbe::at(const glm::dvec3& place) {
  if (!proxy_) return std::nullopt;
  vtkSMPropertyHelper(proxy_, "Position").Set(&place.x, 3);
  proxy_->UpdateVTKObjects();
  vtkSMProperty* const value = proxy_->GetProperty("Value");
  proxy_->UpdatePropertyInformation(value);
  const double found = vtkSMPropertyHelper(value).GetAsDouble();
  return std::isfinite(found) ? std::optional(found) : std::nullopt;
}

std::vector<double> ValueProbe::shares() {
  if (!proxy_) return {};
  vtkSMProperty* const shares = proxy_->GetProperty("Shares");
  proxy_->UpdatePropertyInformation(shares);
  auto found = vtkSMPropertyHelper(shares).GetDoubleArray();
  return found;
}

std::optional<double> ValueProbe::light_part() {
  if (!proxy_) return std::nullopt;
  vtkSMProperty* const part = proxy_->GetProperty("LightPart");
  if (!part) return std::nullopt;  // an older server
  proxy_->UpdatePropertyInformation(part);
  const double found = vtkSMPropertyHelper(part).GetAsDouble();
  return std::isfinite(found) ? std::optional(found) : std::nullopt;
}

}  // namespace palpate::plugin
