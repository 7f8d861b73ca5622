#pragma once

/// The options that name a scan: SERIES [--series N|NAME] [--frame N].

#include <string>

#include "io/series.h"
#include "io/volume.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

struct SeriesOption {
  std::string path;    ///< SERIES: a folder or a file
  std::string series;  ///< --series: a number or name as `palpate info` lists them; empty if only one is usable
  int frame = 0;       ///< --frame: one of several images at a position
};

/// Adds SERIES (required), --series and --frame to a command. `option` must outlive the command.
void add_series_option(CLI::App& command, SeriesOption& option);

/// The series that the option names. Throws WrongUsage with the list of series if it names none and several are usable,
/// or if the named series or frame does not exist; io::DicomError if nothing under the path is usable.
io::Series choose_series(const SeriesOption& option);
/// The same among series already found.
io::Series choose_series(const SeriesOption& option, const io::Catalogue& catalogue);

/// The chosen frame of the chosen series, as open_scan().
io::Volume load_series(const SeriesOption& option);

}  // namespace palpate::plugin
