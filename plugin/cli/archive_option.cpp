#include "plugin/cli/archive_option.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "solver/text/printable.h"

namespace palpate::plugin {

void add_archive_option(CLI::App& command, std::string& name) {
  command.add_option("--archive", name,
                     "which of the archives entered with `palpate archive add`, if there are several");
}

void show_progress(std::string_view text) {
  if (::isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%s\033[K", printable(text).c_str());
}

}  // namespace palpate::plugin
