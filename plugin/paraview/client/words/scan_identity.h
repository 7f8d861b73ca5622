#pragma once

/// The patient, series and date of a scan: shown on the screen so that the user can verify the scan, and never written
/// to a file.

#include <QString>

#include "io/series.h"

namespace palpate::plugin {

/// In lines: patient's name; identifier; number and description of the series; the study's date. Missing items are left
/// out, and those longer than 24 letters end in an ellipsis.
QString identity_text(const io::Series& series);

}  // namespace palpate::plugin
