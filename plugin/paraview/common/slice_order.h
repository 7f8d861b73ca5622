#pragma once

/// The direction in which the scanner numbers its images.

#include "PalpateServerModule.h"
#include "io/series.h"

namespace palpate::plugin {

/// Whether the image numbers (Instance Number; in a file of several frames, their order) fall more often than they rise
/// from a slice to the next of the volume.
PALPATESERVER_EXPORT bool counted_from_last(const io::Series& series);

}  // namespace palpate::plugin
