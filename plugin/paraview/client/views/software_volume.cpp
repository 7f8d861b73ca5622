#include "plugin/paraview/client/views/software_volume.h"

#include <vtkCallbackCommand.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExtractVOI.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRenderer.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <QByteArray>
#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFunctions>

#include <exception>
#include <utility>

#include "plugin/paraview/client/views/castable.h"
#include "plugin/paraview/client/views/caster.h"

namespace palpate::plugin {
namespace {

/// The name of OpenGL's renderer; empty if there is none.
QByteArray renderer_name() {
  QOffscreenSurface surface;
  surface.create();
  QOpenGLContext context;
  if (!context.create() || !context.makeCurrent(&surface)) return {};
  const GLubyte* const name = context.functions()->glGetString(GL_RENDERER);
  QByteArray copy(name ? reinterpret_cast<const char*>(name) : "");
  context.doneCurrent();
  return copy;
}

bool is_of_mesa(const QByteArray& name) {
  const QByteArray low = name.toLower();
  return low.contains("llvmpipe") || low.contains("softpipe") || low.contains("swrast");
}

struct Cancelled : std::exception {};

vtkSmartPointer<vtkImageData> thinned(vtkImageData& image, int step) {
  vtkNew<vtkExtractVOI> thin;
  thin->SetInputData(&image);
  thin->SetVOI(image.GetExtent());
  thin->SetSampleRate(step, step, step);
  thin->Update();
  auto own = vtkSmartPointer<vtkImageData>::New();
  own->ShallowCopy(thin->GetOutput());
  return own;
}

/// The only way to stop VTK's computation of gradients: a progress event on the thread that started it.
void leave_if_cancelled(vtkObject* /*mapper*/, unsigned long /*event*/, void* keep_going, void* /*part*/) {
  if (!(*static_cast<const std::function<bool()>*>(keep_going))()) throw Cancelled();
}

}  // namespace

bool draws_without_card() {
  static const bool without = is_of_mesa(renderer_name());
  return without;
}

PrepareToCast preparing_to_cast(vtkImageData& image, int step) {
  const auto straight = vtkSmartPointer<vtkImageData>::New();
  straight->ShallowCopy(&image);
  straight->SetOrigin(0, 0, 0);
  straight->SetDirectionMatrix(1, 0, 0, 0, 1, 0, 0, 0, 1);
  image.GetPointData()->GetScalars()->GetRange(0);  // kept by the array: the other thread only reads it
  const auto mapper = vtkSmartPointer<Caster>::New();
  mapper->LockSampleDistanceToInputSpacingOn();
  const auto volume = vtkSmartPointer<vtkVolume>::New();
  volume->SetMapper(mapper);
  volume->GetProperty()->ShadeOn();  // gradients are for that
  const auto renderer = vtkSmartPointer<vtkRenderer>::New();
  return [=](const std::function<bool()>& keep_going) -> vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> {
    const auto numbers = of_numbers_alone(*straight);
    mapper->SetInputData(step > 1 ? thinned(*numbers, step) : numbers);
    vtkNew<vtkCallbackCommand> asked;
    asked->SetCallback(&leave_if_cancelled);
    asked->SetClientData(const_cast<std::function<bool()>*>(&keep_going));
    const auto watched = mapper->AddObserver(vtkCommand::VolumeMapperComputeGradientsProgressEvent, asked);
    const int threads = mapper->GetNumberOfThreads();
    mapper->SetNumberOfThreads(1);  // the tissues are found meanwhile
    try {
      mapper->PerVolumeInitialization(renderer, volume);
    } catch (const Cancelled&) {
      return nullptr;
    }
    mapper->SetNumberOfThreads(threads);
    mapper->RemoveObserver(watched);
    return mapper;
  };
}

void light_for_casting(vtkVolumeProperty& theirs, vtkVolumeProperty& ours) {
  ours.SetColor(theirs.GetRGBTransferFunction());
  ours.SetScalarOpacity(theirs.GetScalarOpacity());
  ours.SetScalarOpacityUnitDistance(theirs.GetScalarOpacityUnitDistance());
  ours.SetInterpolationType(theirs.GetInterpolationType());
  ours.SetShade(theirs.GetShade());
  // It takes the light at the eight voxels around a sample: outside of the skin there is little.
  constexpr double lighter = 1.3;
  ours.SetAmbient(lighter * theirs.GetAmbient());
  ours.SetDiffuse(lighter * theirs.GetDiffuse());
  ours.SetSpecular(theirs.GetSpecular());
  ours.SetSpecularPower(theirs.GetSpecularPower());
}

vtkSmartPointer<vtkMatrix4x4> place_of(vtkImageData& image) {
  auto place = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      place->SetElement(row, column, image.GetDirectionMatrix()->GetElement(row, column));
    }
    place->SetElement(row, 3, image.GetOrigin()[row]);
  }
  return place;
}

}  // namespace palpate::plugin
