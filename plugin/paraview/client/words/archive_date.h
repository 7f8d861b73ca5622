#pragma once

#include <QString>

#include <optional>
#include <string>

namespace palpate::plugin {

/// The range of days for an archive's search, from typed text: a year, a month (2026-01), a day (2026-01-04 or
/// 20260104), or a range in DICOM's form. Empty if the text is empty; nothing while a date is incomplete.
std::optional<std::string> archive_date(const QString& typed);

}  // namespace palpate::plugin
