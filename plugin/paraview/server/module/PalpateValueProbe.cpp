#include "plugin/paraview/server/module/PalpateValueProbe.h"

#include <vtkObjectFactory.h>

#include <limits>

vtkStandardNewMacro(PalpateValueProbe);

void PalpateValueProbe::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "Position: " << position_[0] << ", " << position_[1] << ", " << position_[2] << " mm\n";
}

double PalpateValueProbe::GetValue() {
  return reader_ ? reader_->ValueAt(position_[0], position_[1], position_[2])
                 : std::numeric_limits<double>::quiet_NaN();
}

vtkDoubleArray* PalpateValueProbe::GetShares() {
  vtkDoubleArray* const shares = reader_ ? reader_->GetValueShares() : nullptr;
  return shares ? shares : none_.Get();
}

double PalpateValueProbe::GetLightPart() {
  return reader_ ? reader_->GetLightPart() : std::numeric_limits<double>::quiet_NaN();
}
