#pragma once

/// Names and dates of DICOM headers as people write them. For the screen alone: nothing of it is stored.

#include <QString>

#include <string>

namespace palpate::plugin {

/// "Muster, Erika" of "Muster^Erika" (DICOM's value representation PN; the first of its groups).
QString patient_in_words(const std::string& name);

/// "2026-01-04" of "20260104"; what is no date stays as it is.
QString date_in_words(const std::string& date);

/// "10:15" of "101500.000"; empty where it is no time.
QString time_in_words(const std::string& time);

}  // namespace palpate::plugin
