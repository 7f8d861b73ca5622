#include "plugin/cli/session_option.h"

#include <CLI/CLI.hpp>

namespace palpate::plugin {

void add_session_option(CLI::App& command, SessionOption& option) {
  add_series_option(command, option.series);
  command.add_option(
      "--scene", option.scene,
      "a scene's file or the name of a starting scene (default: one that suits the part of the body and the modality)");
  add_probe_path_option(command, option.path);
  add_stylus_option(command, option.stylus);
  command.add_option("--seconds", option.seconds,
                     "how long (default: to the end of the simulated hand's path; with a real stylus, until Ctrl-C)");
  command.add_flag("--live", option.live, "show what is felt, even if stderr is not a terminal");
}

}  // namespace palpate::plugin
