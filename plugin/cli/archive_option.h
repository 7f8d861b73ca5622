#pragma once

/// What the commands that speak to an archive have in common.

#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Adds --archive. `name` has to live as long as the command.
void add_archive_option(CLI::App& command, std::string& name);

/// A line on stderr that is written over, where that is a terminal; an empty text takes it away.
void show_progress(std::string_view text);

}  // namespace palpate::plugin
