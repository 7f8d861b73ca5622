#pragma once

/// How a command is told a structure: FILE, or FILE:SEGMENT with its number or name as `palpate structures` lists them.

#include <string>

#include "io/structures/structure.h"
#include "io/volume.h"

namespace palpate::plugin {

/// A file whose name has a colon is found by its whole name first. Throws WrongUsage with the list of structures if the
/// text names none of several; InputRefused if the file holds none, or none of that name.
io::Structure choose_structure(const std::string& text);

/// The same, put on a scan. Says on stderr what a user should know of it. Throws InputRefused if it cannot be felt on
/// that scan, too.
io::Structure choose_structure(const std::string& text, const io::Volume& scan);

}  // namespace palpate::plugin
