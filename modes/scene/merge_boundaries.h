#pragma once

/// Merges boundaries of a CT that have one name for a clinician: skin over fat and skin over muscle are *Skin*.

#include <vector>

#include "modes/scene/suggest.h"

namespace palpate::modes::internal {

/// Merges boundaries if their lower tissues have the same name and their higher ones too (fat counts as soft tissue),
/// and if one value lies well between the two tissues of each. Two kinds of bone in soft tissue are not merged. The
/// merged boundary is felt at that value and has the sum of the shares. It lies between new tissues, which are added to
/// the suggestion and span the ranges of the parts. The most frequent boundary comes first, as before.
void merge_boundaries(std::vector<FoundBoundary>& boundaries, Suggestion& suggestion);

}  // namespace palpate::modes::internal
