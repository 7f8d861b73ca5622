#pragma once

#include <QImage>

#include "io/series.h"

namespace palpate::plugin {

/// How wide and high a thumbnail is.
inline constexpr int thumbnail_pixels = 128;

/// The middle slice of a series in its true proportions, gray, in the series' own window or else in that of its middle
/// 98 percent. Empty if it cannot be read.
QImage thumbnail_of(const io::Series& series);

}  // namespace palpate::plugin
