#pragma once

/// The option that names a structure: FILE, or FILE:SEGMENT with its number or name as in `palpate structures`.

#include <string>

#include "io/structures/structure.h"
#include "io/volume.h"

namespace palpate::plugin {

/// If the whole text is the name of a file, its colon does not count. If digits are both the number of one structure
/// and the name of another, the number counts. Throws WrongUsage with the list of structures if there are several and
/// the text names none of them; InputRefused if the file holds no structure, none with that name, or several.
io::Structure choose_structure(const std::string& text);

/// The same, placed on a scan. Prints warnings on stderr. Also throws InputRefused if it cannot be felt on that scan.
io::Structure choose_structure(const std::string& text, const io::Volume& scan);

}  // namespace palpate::plugin
