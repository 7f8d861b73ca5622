#pragma once

/// Who was scanned, which series and when: shown on the screen so that the right scan can be verified, and written
/// nowhere.

#include <QString>

#include "io/series.h"

namespace palpate::plugin {

/// In lines: patient's name; identifier; number and description of the series; the study's date. What the files do not
/// say is left out, what is longer than 24 letters ends in an ellipsis.
QString identity_text(const io::Series& series);

}  // namespace palpate::plugin
