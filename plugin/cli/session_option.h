#pragma once

/// The options shared by `palpate probe`, `record` and `serve`: scan, scene, stylus, duration.

#include <string>

#include "plugin/options/probe_path.h"
#include "plugin/options/series_option.h"
#include "plugin/options/stylus_option.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

struct SessionOption {
  SeriesOption series;
  StylusChoice stylus;
  ProbePathOption path;
  std::string scene;
  double seconds = 0;
  bool live = false;
};
void add_session_option(CLI::App& command, SessionOption& option);

}  // namespace palpate::plugin
