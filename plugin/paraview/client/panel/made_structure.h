#pragma once

/// What is made of a structure in the background: how large it is, how it is drawn, and what its edits have changed.

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
  std::vector<io::Edit> edits;                            ///< of its outline, the scene's, and contours that make it
  std::shared_ptr<const io::StructureMeasures> measures;  ///< where they are known
  std::shared_ptr<const io::DistanceField> outline;       ///< before its edits, as it is felt; null: it is not felt
  vtkSmartPointer<vtkPolyData> surface_before;            ///< of the file's outline, where it is known
  bool draws = false;
  std::shared_ptr<const io::Volume> scan;
};

struct MadeStructure {
  io::Structure structure;
  std::weak_ptr<const io::Volume> scan;  ///< that it was made on
  std::vector<io::Edit> edits;
  std::string error;                                      ///< empty if all was made
  std::shared_ptr<const io::StructureMeasures> measures;  ///< of the outline in its file
  std::shared_ptr<const io::DistanceField> outline;       ///< that the edits change; null where it is not drawn
  DrawnStructure drawn;                                   ///< without a distance where it is not drawn
  std::optional<io::OutlineChange> change;                ///< by the edits; none if there are none
  OutlineEdges edges;                                     ///< the scan's own at the file's outline
};

/// Fields are shared with those who feel them. Throws nothing.
MadeStructure make_structure(const WantedStructure& wanted);

}  // namespace palpate::plugin
