#pragma once

/// A thin frame in the active view: keys and *One-up* apply to it.

#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <QObject>

class pqRenderView;
class vtkActor2D;
class vtkRenderer;

namespace palpate::plugin {

class ViewMark : public QObject {
 public:
  explicit ViewMark(pqRenderView& view);
  ~ViewMark() override;

 private:
  void follow();

  pqRenderView& view_;
  vtkSmartPointer<vtkRenderer> renderer_;
  vtkNew<vtkActor2D> frame_;
};

}  // namespace palpate::plugin
