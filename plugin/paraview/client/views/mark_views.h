#pragma once

/// Marks in the views of a scan: balls with their names, paths, distances and angles with what they measure. On a slice
/// what lies on it, and fainter what lies near it.

#include <functional>
#include <memory>
#include <vector>

#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

class MarkViews {
 public:
  /// What is drawn, asked for whenever it is.
  using Ask = std::function<const Marks&()>;
  MarkViews(OpenViews& views, Ask marks);
  ~MarkViews();
  MarkViews(const MarkViews&) = delete;
  MarkViews& operator=(const MarkViews&) = delete;

  /// The marks that are chosen are drawn larger, and what lies between them with a line.
  void set_chosen(std::vector<std::size_t> chosen);
  /// Draws all anew.
  void refresh();

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);
  /// Draws what is on the slice that a view shows now. The caller renders the view.
  void show(SliceView& slice);
  void draw(One& one);

  Ask marks_;
  std::vector<std::size_t> chosen_;
  std::vector<std::unique_ptr<One>> views_;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
