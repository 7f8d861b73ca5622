#include "plugin/paraview/client/views/casting.h"

#include <utility>

#include "plugin/paraview/client/views/software_volume.h"

namespace palpate::plugin {

void Casting::prepare(vtkImageData& image) {
  if (image_ == &image) return;
  image_ = &image;
  // Half of them along each axis first: an eighth of the time.
  constexpr vtkIdType many_voxels = 20'000'000;
  coarse_ = !mapper_ && image.GetNumberOfPoints() > many_voxels;
  cast(coarse_ ? 2 : 1);
}

void Casting::cast(int step) {
  job_.cancel();
  job_.ask(
      [prepare = preparing_to_cast(*image_, step)](const Job::Control& control) { return prepare(control.keep_going); },
      [this](const auto& mapper, const QString&) { take(mapper ? mapper->Get() : nullptr); });
}

void Casting::take(vtkFixedPointVolumeRayCastMapper* mapper) {
  if (mapper) mapper_ = mapper;  // else the coarse one stays, where there is one
  failed_ = !mapper_;
  changed_();
  if (std::exchange(coarse_, false) && mapper && image_) cast(1);
}

void Casting::forget() {
  job_.cancel();
  image_ = nullptr;
  mapper_ = nullptr;
  failed_ = false;
}

}  // namespace palpate::plugin
