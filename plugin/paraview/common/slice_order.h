#pragma once

/// The order in which the scanner numbers its images.

#include "PalpateServerModule.h"
#include "io/series.h"

namespace palpate::plugin {

/// Whether image numbers (Instance Number; in a file of several frames, their order) mostly fall from slice to slice of
/// the volume.
PALPATESERVER_EXPORT bool counted_from_last(const io::Series& series);

}  // namespace palpate::plugin
