#pragma once

/// Prepares in the background a mapper that draws a volume without a graphics card: for a large volume first a coarse
/// one, then one of all voxels. Until then the previous one is drawn.

#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <functional>

#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class Casting {
 public:
  /// `changed`: called when mapper() or can_cast() has changed.
  explicit Casting(std::function<void()> changed) : changed_(std::move(changed)) {}

  /// Does nothing for an image that is already prepared or being prepared.
  void prepare(vtkImageData& image);
  /// Another scan: drops the previous scan's mapper.
  void forget();
  /// To be called before the object that draws is destroyed.
  void finish() { job_.finish(); }
  /// Null: not ready yet.
  vtkFixedPointVolumeRayCastMapper* mapper() const { return mapper_; }
  /// False: preparation has failed.
  bool can_cast() const { return !failed_; }

 private:
  void cast(int step);
  void take(vtkFixedPointVolumeRayCastMapper* mapper);

  std::function<void()> changed_;
  vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> mapper_;
  vtkSmartPointer<vtkImageData> image_;
  bool coarse_ = false;  // of the mapper being prepared
  bool failed_ = false;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
