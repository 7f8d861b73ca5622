#pragma once

/// The field of a structure after an edit. All callers share one field while any of them holds it, as in
/// shared_distance.h: drawing and force use the same field, and no edit is computed twice.

#include <memory>
#include <span>
#include <vector>

#include "io/structures/edits.h"
#include "io/volume.h"

namespace palpate::plugin {

/// From any thread. The same bits as io::apply_edit(). If the scan has no owner, the field is not shared with other
/// calls.
std::shared_ptr<const io::DistanceField> shared_edited(const std::shared_ptr<const io::DistanceField>& before,
                                                       const io::Edit& edit,
                                                       const std::shared_ptr<const io::Volume>& scan);

/// The field before the first edit and after each of them, in their order. Throws InvalidInput that begins with the
/// edit: "edit 3: trace: ...".
std::vector<std::shared_ptr<const io::DistanceField>> shared_edited(std::shared_ptr<const io::DistanceField> before,
                                                                    std::span<const io::Edit> edits,
                                                                    const std::shared_ptr<const io::Volume>& scan);

}  // namespace palpate::plugin
