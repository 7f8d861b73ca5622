#pragma once

/// A velocity field as arrows on the slices: its component within the slice, by direction and speed.

#include <QPointer>

#include <memory>
#include <vector>

#include "io/fields/field_source.h"
#include "io/volume.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

class FlowViews {
 public:
  explicit FlowViews(OpenViews& views);
  ~FlowViews();
  FlowViews(const FlowViews&) = delete;
  FlowViews& operator=(const FlowViews&) = delete;

  /// The volume to draw; nothing is drawn if it is not a vector field.
  void set_volume(const std::shared_ptr<const io::Volume>& volume);

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);
  /// Draws the arrows of the slice that a view shows now.
  void show(SliceView& slice);

  std::vector<std::unique_ptr<One>> views_;
  std::shared_ptr<const io::FieldSource> field_;
  double fastest_ = 0;  // in the volume
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
