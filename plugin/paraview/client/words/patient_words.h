#pragma once

/// Names and dates of DICOM headers as people write them. Only for the screen: they are not stored.

#include <QString>

#include <string>

namespace palpate::plugin {

/// "Muster, Erika" for "Muster^Erika" (DICOM's value representation PN; the first of its groups).
QString patient_in_words(const std::string& name);

/// "2026-01-04" for "20260104"; any other text is unchanged.
QString date_in_words(const std::string& date);

/// "10:15" for "101500.000"; empty for any other text.
QString time_in_words(const std::string& time);

}  // namespace palpate::plugin
