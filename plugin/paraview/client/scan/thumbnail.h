#pragma once

#include <QImage>

#include "io/series.h"

namespace palpate::plugin {

/// The middle slice of a series, small and gray, in the series' own window or else that of its middle 98 percent. Empty
/// where it cannot be read.
QImage thumbnail_of(const io::Series& series);

}  // namespace palpate::plugin
