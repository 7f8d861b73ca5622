#pragma once

/// Prepares in the background a mapper that draws a volume without a graphics card: first a coarse one for a large
/// volume, then that of all voxels. What was there before is drawn until then.

#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <functional>

#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class Casting {
 public:
  /// `changed`: mapper() or can_cast() has.
  explicit Casting(std::function<void()> changed) : changed_(std::move(changed)) {}

  /// Does nothing for the image that it prepares, or has prepared, already.
  void prepare(vtkImageData& image);
  /// Another scan: what was prepared is of the one before.
  void forget();
  /// Before the end of what draws it.
  void finish() { job_.finish(); }
  /// Null: there is none yet.
  vtkFixedPointVolumeRayCastMapper* mapper() const { return mapper_; }
  /// False: none could be prepared.
  bool can_cast() const { return !failed_; }

 private:
  void cast(int step);
  void take(vtkFixedPointVolumeRayCastMapper* mapper);

  std::function<void()> changed_;
  vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> mapper_;
  vtkSmartPointer<vtkImageData> image_;
  bool coarse_ = false;  // what is being prepared
  bool failed_ = false;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
