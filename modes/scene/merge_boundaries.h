#pragma once

/// Merges boundaries of a CT that a clinician calls by the same name: skin over fat and skin over muscle are *Skin*.

#include <vector>

#include "modes/scene/suggest.h"

namespace palpate::modes::internal {

/// Merges boundaries if their lower tissues have the same name and their higher ones too (fat counts as soft tissue),
/// and if one value lies well between the two tissues of every one of them. Two kinds of bone in soft tissue are not
/// merged. The merged boundary is felt at that value, and its share of the voxels is their sum. On a side where their
/// tissues differ, a tissue that spans them is added to the suggestion. The most frequent boundary comes first, as
/// before.
void merge_boundaries(std::vector<FoundBoundary>& boundaries, Suggestion& suggestion);

}  // namespace palpate::modes::internal
