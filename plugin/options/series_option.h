#pragma once

/// How every command that works on a scan is told which: SERIES [--series N|UID] [--frame N].

#include <string>
#include <vector>

#include "io/progress.h"
#include "io/series.h"
#include "io/volume.h"

namespace CLI {
class App;
}

namespace palpate::plugin {

struct SeriesOption {
  std::string path;  ///< SERIES: a folder or a file
  std::string
      series;     ///< --series: a number as `palpate info` counts, or a UID; empty where there is but one usable series
  int frame = 0;  ///< --frame: which of several images at a position
};

/// Adds SERIES (required), --series and --frame to a command. `option` has to live as long as the command.
void add_series_option(CLI::App& command, SeriesOption& option);

/// The series that the option names. Throws WrongUsage with the list of series where it names none and several are
/// usable, names one that is not there, or a frame that it has not; io::DicomError where nothing under the path can be
/// used.
io::Series choose_series(const SeriesOption& option);
/// The same among series already found.
io::Series choose_series(const SeriesOption& option, const io::Catalogue& catalogue);

/// The chosen series, chosen frame; warnings go to stderr, and progress where stderr is a terminal.
io::Volume load_series(const SeriesOption& option);

/// All that --series can name, in the order in which it is numbered: the series, then the velocity fields made of some.
std::vector<io::Series> numbered_series(const io::Catalogue& catalogue);

/// One line on a series: its number, modality, description, size, spacing, frames and UID.
std::string describe_series(std::size_t number, const io::Series& series);

/// Control characters in the form \x1b: a file's name or a description may hold what a terminal would obey.
std::string printable(const std::string& text);

/// A progress line on stderr, with `what` before the percentage; an empty one where stderr is no terminal.
io::Progress terminal_progress(std::string what);

}  // namespace palpate::plugin
