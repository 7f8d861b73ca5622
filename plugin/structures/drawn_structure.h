#pragma once

/// Structures defined by contours in the scene instead of a file: they can be measured, drawn, corrected and written.

#include <cstddef>

#include "io/structures/edit.h"
#include "io/structures/structure.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

/// A structure whose edits begin with contours (modes::is_drawn()). It has no file; its name is the scene's.
io::Structure drawn_structure(const modes::SceneStructure& named);

/// The contours that define it; null: a file does.
const io::ContoursEdit* contours_of(const io::Structure& structure);

/// The number of edits at the beginning that define the structure: 1 for contours, otherwise 0.
inline std::size_t making_edits(const io::Structure& structure) {
  return contours_of(structure) ? 1 : 0;
}

/// Whether both are the same structure of the same file, or contours of the same name in the scene.
inline bool is_same(const io::Structure& a, const io::Structure& b) {
  return a.file == b.file && a.number == b.number && (!a.file.empty() || a.name == b.name);
}

}  // namespace palpate::plugin
