#pragma once

/// A picture of a suggestion: its boundaries on two slices, and the pairs of values in which they were found.

#include <filesystem>
#include <memory>

#include "io/volume.h"
#include "modes/scene/suggest.h"

namespace palpate::plugin {

/// Throws std::runtime_error naming the file.
void write_suggestion_png(const modes::Suggestion& suggestion, const std::shared_ptr<const io::Volume>& volume,
                          const std::filesystem::path& file);

}  // namespace palpate::plugin
