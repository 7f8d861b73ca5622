#pragma once

#include <QImage>

#include "io/series.h"

namespace palpate::plugin {

/// Width and height of a thumbnail.
inline constexpr int thumbnail_pixels = 128;

/// The middle slice of a series in its true proportions, gray, with the series' own window, or else that of the middle
/// 98 percent of the values. Empty if it cannot be read.
QImage thumbnail_of(const io::Series& series);

}  // namespace palpate::plugin
