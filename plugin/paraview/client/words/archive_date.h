#pragma once

#include <QString>

#include <optional>
#include <string>

namespace palpate::plugin {

/// The span of days that an archive is asked for, of what a person types: a year, a month (2026-01), a day (2026-01-04
/// or 20260104), or a span as DICOM has it. Empty if nothing is typed; nothing while a date is only begun.
std::optional<std::string> archive_date(const QString& typed);

}  // namespace palpate::plugin
