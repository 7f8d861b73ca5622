#pragma once

/// The rows of a recording's tables, and its events as text: used by the writer and the reader.

#include <string>
#include <string_view>

#include "plugin/recording/hdf5_handle.h"
#include "plugin/recording/recording.h"

namespace palpate::plugin {

hdf5::Handle tick_row_type();
hdf5::Handle share_row_type();
hdf5::Handle known_to_row_type();

/// A line of JSON, with its line feed.
std::string to_line(const SceneRecord& scene);
std::string to_line(const StylusRecord& stylus);
std::string to_line(const Gap& gap);
/// Adds the events in the lines to the recording. An incomplete last line is ignored. Throws std::exception for lines
/// that to_line() does not write.
void read_events(std::string_view lines, Recording& recording);

}  // namespace palpate::plugin
