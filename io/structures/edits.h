#pragma once

/// Applies edits to a structure's distance field. The result is a new field; the old one is unchanged, so an edit is
/// undone by taking the old field. Both share all unchanged bricks.
///
/// A trace adds radial functions to the distance phi: phi' = phi + sum c_i w(|x - p_i| / R), w = (1-r)^4 (4r+1), with
/// (W + diag(mu s_i^2)) c = -phi(p_i). (H. Wendland, "Piecewise polynomial, positive definite and compactly supported
/// radial functions of minimal degree", Adv. Comput. Math. 4, 1995: once and twice differentiable, positive definite.)
/// add and remove join and cut with a polynomial smooth maximum, which is once differentiable and exact elsewhere.
/// After each edit phi' is made a distance again. Laws, which edits_laws_test.cpp checks:
///  - a trace goes through its points (those kept by the thinning) within 0.05 mm if they are exact;
///  - the distance keeps its bits where the nearest edge, before and after, is beyond the reach;
///  - a trace of the unchanged edge changes less than 0.01 mm; edits that are far apart commute;
///  - scan_edge keeps all parts and closed cavities, and moves no farther than asked (edit_scan_edge_laws_test.cpp).
///    Tunnels through a part are not checked.

#include <memory>
#include <span>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/edit.h"
#include "io/structures/scan_edge.h"

namespace palpate::io {

struct EditOptions {
  /// The scan's raw values, for scan_edge. Null: scan_edge is refused.
  const ScanValues* scan = nullptr;
  /// How the field of a new structure is made, for contours.
  DistanceOptions distance{};
  int threads = 0;  ///< 0: all cores; the result is the same on any number
};

/// The result of an edit, to be shown to the user.
struct EditOutcome {
  double largest_mm = 0;   ///< bound on how far the edge moved: the largest change of a traced or moved point; for add
                           ///< and remove, the largest distance of the tube's surface from the old edge; 0 for contours
  std::size_t points = 0;  ///< points that the edge was put through; for scan_edge: sampled places
  std::size_t without_edge = 0;  ///< for scan_edge: places at which the scan has no edge; the outline stays there
  std::size_t held_back = 0;  ///< for scan_edge: places where the outline stops short of the edge by more than 0.5 mm
                              ///< and the edge's uncertainty (see EdgeWay::is_held_back)
};

struct Edited {
  std::shared_ptr<const DistanceField> field;
  std::vector<EditOutcome> outcomes;  ///< one for each edit
};

/// The field after one edit. Throws InvalidInput; its text begins with the type of the edit: "trace: its point 3 lies
/// ...". `before` may be null for contours only.
std::shared_ptr<const DistanceField> apply_edit(const std::shared_ptr<const DistanceField>& before, const Edit& edit,
                                                const EditOptions& options = {}, EditOutcome* outcome = nullptr);

/// The same for a list, in its order; a refusal begins with "edit 3: ".
Edited apply_edits(std::shared_ptr<const DistanceField> before, std::span<const Edit> edits,
                   const EditOptions& options = {});

}  // namespace palpate::io
