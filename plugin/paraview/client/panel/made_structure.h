#pragma once

/// Data of a structure that are computed in the background: its size, its drawing, and the change by its edits.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/structures/outline_change.h"
#include "io/structures/structure.h"
#include "plugin/paraview/client/views/structure_views.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin {

struct WantedStructure {
  io::Structure structure;
  std::vector<io::Edit> edits;  ///< the scene's edits of its outline, including contours that define it
  std::shared_ptr<const io::StructureMeasures> measures;  ///< if known
  std::shared_ptr<const io::DistanceField> outline;       ///< the felt field, without the edits; null: not felt
  vtkSmartPointer<vtkPolyData> surface_before;            ///< of the file's outline, if known
  bool draws = false;
  std::shared_ptr<const io::Volume> scan;
};

struct MadeStructure {
  io::Structure structure;
  std::weak_ptr<const io::Volume> scan;  ///< the scan that it was computed for
  std::vector<io::Edit> edits;
  std::string error;                                      ///< empty if everything was computed
  std::shared_ptr<const io::StructureMeasures> measures;  ///< of the outline in its file
  std::shared_ptr<const io::DistanceField> outline;       ///< the input of the edits; null if not drawn
  DrawnStructure drawn;                                   ///< without a distance if not drawn
  std::optional<io::OutlineChange> change;                ///< by the edits; none if there are none
  OutlineEdges edges;                                     ///< of the scan, at the file's outline
};

/// Shares its fields with the session. Throws nothing.
MadeStructure make_structure(const WantedStructure& wanted);

}  // namespace palpate::plugin
