#pragma once

/// The archives that a user has entered, and where what is fetched lies: shared by the command line and the panel.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/archive/archive.h"

namespace palpate::plugin {

/// $XDG_CONFIG_HOME/palpate/archives.json, or the same under ~/.config.
std::filesystem::path archive_settings_file();

/// Empty where there is no file yet. Throws std::runtime_error naming the file where it cannot be read.
std::vector<io::Archive> read_archives();
/// Readable by its owner alone; the old file stays until the new one is whole. Throws std::runtime_error naming it.
void write_archives(const std::vector<io::Archive>& archives);

/// Throws InputRefused where there is none of that name, or several and none is named; with the names there are.
io::Archive archive_named(const std::string& name);

/// $XDG_CACHE_HOME/palpate/fetched, or the same under ~/.cache: where what is fetched lies unless a folder is named.
std::filesystem::path fetched_folder();

struct OnDisk {
  std::size_t series = 0;
  std::uint64_t bytes = 0;
};
OnDisk fetched_on_disk();
/// Deletes all of it. Throws std::runtime_error naming what cannot be deleted.
void empty_fetched();

}  // namespace palpate::plugin
