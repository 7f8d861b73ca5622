#pragma once

/// A vertical line across a chart.

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
  /// Its position along the chart's width, 0 to 1; other values hide it. Returns whether it has moved.
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
