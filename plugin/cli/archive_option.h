#pragma once

/// Shared by the commands that use an archive.

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Adds --archive. `name` must outlive the command.
void add_archive_option(CLI::App& command, std::string& name);

/// Overwrites a line on stderr, if that is a terminal; an empty text removes it.
void show_progress(std::string_view text);

}  // namespace palpate::plugin
