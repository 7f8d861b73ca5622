#pragma once

/// Applies edits to a structure's distance field. The result is a new field: the one before stays as it was, so that
/// to undo an edit is to take the field before it. Both share all bricks that are the same.
///
/// A trace adds radial functions to the distance phi: phi' = phi + sum c_i w(|x - p_i| / R), w = (1-r)^4 (4r+1), with
/// (W + diag(mu s_i^2)) c = -phi(p_i). (H. Wendland, "Piecewise polynomial, positive definite and compactly supported
/// radial functions of minimal degree", Adv. Comput. Math. 4, 1995: once and twice differentiable, positive definite.)
/// add and remove join and cut with a polynomial smooth maximum, which is once differentiable and exact elsewhere.
/// After each edit phi' is made a distance again. Laws, which edits_laws_test.cpp checks:
///  - a trace goes through its points (those kept by the thinning) within 0.05 mm if they are exact;
///  - the distance keeps its bits wherever the nearest edge, before and after, lies beyond the reach;
///  - a trace of the edge as it is changes less than 0.01 mm; edits that are far apart commute;
///  - scan_edge keeps all parts and closed cavities, and moves no farther than asked (edit_scan_edge_laws_test.cpp).
///  That
///    a tunnel through a part stays is not checked.

#include <memory>
#include <span>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/edit.h"
#include "io/structures/scan_edge.h"

namespace palpate::io {

struct EditOptions {
  /// For scan_edge: the scan's raw values. Null: such an edit is refused.
  const ScanValues* scan = nullptr;
  /// For contours: how the field of the new structure is made.
  DistanceOptions distance{};
  int threads = 0;  ///< 0: all cores; the result is the same on any number
};

/// What an edit did, to be shown to the user.
struct EditOutcome {
  double largest_mm = 0;         ///< how far the edge moved, as a bound: the largest change of a traced or moved point
  std::size_t points = 0;        ///< that the edge was put through; of scan_edge: places that were looked at
  std::size_t without_edge = 0;  ///< of scan_edge: places at which the scan has no edge; the outline stays there
  std::size_t held_back = 0;  ///< likewise: with an edge that the outline does not reach, by more than 0.5 mm and its
                              ///< +-, as places around say otherwise, the radius is near, or a part would appear or go
};

struct Edited {
  std::shared_ptr<const DistanceField> field;
  std::vector<EditOutcome> outcomes;  ///< one for each edit
};

/// The field after one edit. Throws InvalidInput in words that begin with what the edit is: "trace: its point 3 lies
/// ...". `before` may be null for contours alone.
std::shared_ptr<const DistanceField> apply_edit(const std::shared_ptr<const DistanceField>& before, const Edit& edit,
                                                const EditOptions& options = {}, EditOutcome* outcome = nullptr);

/// The same for a list, in its order; a refusal begins with "edit 3: ".
Edited apply_edits(std::shared_ptr<const DistanceField> before, std::span<const Edit> edits,
                   const EditOptions& options = {});

}  // namespace palpate::io
