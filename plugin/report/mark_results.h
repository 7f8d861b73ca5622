#pragma once

/// Results of marks that are stored in the scan's study.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/results/measurement_report.h"
#include "io/series.h"
#include "io/volume.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

/// The marks, distances and paths for a report. Angles are left out: TID 1500 has no entry for them.
io::MeasurementReport report_of(const Marks& marks);

/// The content of the report, a line for each mark, distance and path. `unit`: of the scan.
std::string report_in_words(const io::MeasurementReport& report, const std::string& unit);

/// Writes the report, and a picture of each mark, into an existing folder. Returns the files, the report first. Throws
/// as io::write_measurement_report() does.
std::vector<std::filesystem::path> write_results(const io::Series& series,
                                                 const std::shared_ptr<const io::Volume>& volume, const Marks& marks,
                                                 const std::filesystem::path& folder);

}  // namespace palpate::plugin
