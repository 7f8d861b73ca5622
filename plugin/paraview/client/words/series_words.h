#pragma once

/// The details that distinguish a series in its folder, for a list and for cards.

#include <QString>

#include "io/series.h"

namespace palpate::plugin {

/// "4  Thorax 1.0 B30f": number and description, as the scanner's own list has it.
QString series_title(const io::Series& series);

/// "2026-01-04 10:15 · CHEST · axial · kernel B30f · 1 mm thick, every 0.7 mm · 320 slices". Missing items are left
/// out.
QString series_details(const io::Series& series);

/// Why it is the one to begin with: "slices every 1.00 mm, soft kernel B30f, 512 slices".
QString why_first(const io::Series& series);

/// Why it cannot be felt; empty if it can.
QString why_not_usable(const io::Series& series);

}  // namespace palpate::plugin
