#pragma once

/// The archives that a user has configured. The command line and the panel share them.

#include <filesystem>
#include <string>
#include <vector>

#include "io/archive/archive.h"

namespace palpate::plugin {

/// $XDG_CONFIG_HOME/palpate/archives.json, or the same under ~/.config.
std::filesystem::path archive_settings_file();

/// Empty if there is no file yet. Throws std::runtime_error that names the file if it cannot be read.
std::vector<io::Archive> read_archives();
/// The file is readable by its owner alone. The old file stays until the new one is complete. Throws std::runtime_error
/// that names the file.
void write_archives(const std::vector<io::Archive>& archives);

/// The archive of that name; an empty name means the only one. Throws InputRefused with the list of names if there is
/// none of that name, or if the name is empty and there are several.
io::Archive archive_named(const std::string& name);

/// The program's folder in one of the user's folders: in the one that the environment variable `variable` names, or
/// else in `under_home` (XDG base directory specification). Throws InputRefused if neither is an absolute path.
std::filesystem::path user_folder(const char* variable, const char* under_home);

}  // namespace palpate::plugin
