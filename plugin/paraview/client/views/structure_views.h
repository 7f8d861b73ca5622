#pragma once

/// Structures in the views of a scan: outlines on the slices, surfaces in the volume view.

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <QColor>

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "io/structures/distance_field.h"
#include "plugin/paraview/client/model/open_views.h"
#include "plugin/paraview/client/views/clinical_views.h"

namespace palpate::plugin {

struct DrawnStructure {
  std::shared_ptr<const io::DistanceField> distance;
  std::shared_ptr<const io::DistanceField> before = {};  ///< without edits: a thin line; null: no edits
  glm::dvec3 low_mm{0}, high_mm{0};                      ///< a box around all of it
  vtkSmartPointer<vtkPolyData> surface;
  vtkSmartPointer<vtkPolyData> surface_before = {};  ///< of `before`, if known
  QColor color;
  /// Distances at which the force of a keep-out or keep-in begins, mm: inside positive; each is a thin line.
  std::vector<double> margins_mm = {};
  bool operator==(const DrawnStructure&) const = default;
};

class StructureViews {
 public:
  explicit StructureViews(OpenViews& views);
  ~StructureViews();
  StructureViews(const StructureViews&) = delete;
  StructureViews& operator=(const StructureViews&) = delete;

  /// `opacity` is that of the surfaces.
  void set_structures(std::vector<DrawnStructure> structures, double opacity);

 private:
  struct One;
  void set_views(const std::vector<ClinicalView>& views);
  /// Draws the outlines in the slice that a view shows now.
  void show(SliceView& slice);

  std::vector<DrawnStructure> structures_;
  double opacity_ = 0.4;
  std::vector<std::unique_ptr<One>> views_;
  OpenViews::Following following_;
};

}  // namespace palpate::plugin
