#pragma once

/// Structures that a scene's contours make, beside those of files: they can be measured, drawn, corrected and written.

#include <cstddef>

#include "io/structures/edit.h"
#include "io/structures/structure.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

/// Of a structure whose edits begin with contours (modes::is_drawn()). It has no file; its name is the scene's.
io::Structure drawn_structure(const modes::SceneStructure& named);

/// The contours that make it; null: a file does.
const io::ContoursEdit* contours_of(const io::Structure& structure);

/// How many of its edits make the outline that the others change: the contours, or none.
inline std::size_t making_edits(const io::Structure& structure) {
  return contours_of(structure) ? 1 : 0;
}

/// Whether both are the same structure of the same file, or drawn in the scene by the same name.
inline bool is_same(const io::Structure& a, const io::Structure& b) {
  return a.file == b.file && a.number == b.number && (!a.file.empty() || a.name == b.name);
}

}  // namespace palpate::plugin
