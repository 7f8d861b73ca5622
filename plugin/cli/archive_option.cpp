#include "plugin/cli/archive_option.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

namespace palpate::plugin {

void add_archive_option(CLI::App& command, std::string& name) {
  command.add_option("--archive", name,
                     "which of the archives entered with `palpate archive add`, where there are several");
}

void show_progress(std::string_view text) {
  if (::isatty(STDERR_FILENO) == 0) return;
  std::fprintf(stderr, "\r%.*s\033[K", static_cast<int>(text.size()), text.data());
}

std::string for_terminal(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7F; }, '?');
  return text;
}

}  // namespace palpate::plugin
