#pragma once

/// A line from the bottom to the top of a chart.

#include <vtkChart.h>
#include <vtkContextItem.h>
#include <vtkSmartPointer.h>

namespace palpate::plugin {

class ChartMark : public vtkContextItem {
 public:
  static ChartMark* New();
  vtkTypeMacro(ChartMark, vtkContextItem)

      void set_chart(vtkChart* chart) {
    chart_ = chart;
  }
  /// How far along the chart's width, 0 to 1; elsewhere: none. Whether it is another place than before.
  bool set_part(double part);
  bool Paint(vtkContext2D* painter) override;

  ChartMark(const ChartMark&) = delete;
  ChartMark& operator=(const ChartMark&) = delete;

 protected:
  ChartMark() = default;

 private:
  vtkSmartPointer<vtkChart> chart_;
  double part_ = -1;
};

}  // namespace palpate::plugin
