#pragma once

/// The archives that a user has entered. The command line and the panel share them.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
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

/// How the archive is reached, as the settings and `palpate archive list --json` have it: name, host, port, AE titles,
/// how it is fetched from, and where it sends to.
nlohmann::ordered_json connection_json(const io::Archive& archive);

/// The archive of that name; an empty name means the only one. Throws InputRefused, with the names that there are, if
/// there is none of that name, or if no name is given and there are several.
io::Archive archive_named(const std::string& name);

/// The program's folder in one of the user's folders: in the one that the environment variable `variable` names, or
/// else in `under_home` (XDG base directory specification). Throws InputRefused if neither is an absolute path.
std::filesystem::path user_folder(const char* variable, const char* under_home);

}  // namespace palpate::plugin
