#pragma once

/// Boundaries of a CT that have one name for a clinician become one: skin over fat and skin over muscle are *Skin*.

#include <vector>

#include "modes/scene/suggest.h"

namespace palpate::modes::internal {

/// Merges boundaries whose lower and whose higher tissues have the same name but for fat and soft tissue, as far as one
/// value lies well between the two tissues of each; not two kinds of bone in tissue. The merged one is felt at that
/// value, has the shares of all, and lies between tissues of its own, which are added to the suggestion: they reach
/// over those of the parts. The most frequent boundary comes first, as before.
void merge_boundaries(std::vector<FoundBoundary>& boundaries, Suggestion& suggestion);

}  // namespace palpate::modes::internal
