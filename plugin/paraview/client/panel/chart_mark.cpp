#include "plugin/paraview/client/panel/chart_mark.h"

#include <vtkContext2D.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>

#include <utility>

namespace palpate::plugin {

vtkStandardNewMacro(ChartMark);

bool ChartMark::set_part(double part) {
  if (std::exchange(part_, part) == part) return false;
  Modified();
  return true;
}

bool ChartMark::Paint(vtkContext2D* painter) {
  if (!chart_ || part_ < 0 || part_ > 1) return true;
  const int* const low = chart_->GetPoint1();
  const int* const high = chart_->GetPoint2();
  const auto x = static_cast<float>(low[0] + part_ * (high[0] - low[0]));
  vtkPen& pen = *painter->GetPen();
  pen.SetLineType(vtkPen::SOLID_LINE);
  pen.SetColor(213, 94, 0, 255);  // opaque, whatever was painted before it
  pen.SetWidth(2);
  painter->DrawLine(x, static_cast<float>(low[1]), x, static_cast<float>(high[1]));
  return true;
}

}  // namespace palpate::plugin
