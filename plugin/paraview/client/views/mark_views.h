#pragma once

/// Marks in the views of a scan: balls with names, paths, distances and angles with their values. A slice shows the
/// marks on it, and, more faintly, the marks near it.

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

class MarkViews {
 public:
  /// Returns the marks at each drawing.
  using Ask = std::function<const Marks&()>;
  MarkViews(OpenViews& views, Ask marks);
  ~MarkViews();
  MarkViews(const MarkViews&) = delete;
  MarkViews& operator=(const MarkViews&) = delete;

  /// Chosen marks are drawn larger, with lines between them.
  void set_chosen(std::vector<std::size_t> chosen);
  /// Draws everything again.
  void refresh();

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);
  /// Draws the marks on the slice that a view shows now. The caller renders the view.
  void show(SliceView& slice);
  void draw(One& one);

  Ask marks_;
  std::vector<std::size_t> chosen_;
  std::vector<std::unique_ptr<One>> views_;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
