#pragma once

/// Queries an archive: studies by patient, id, date, modality and description, and their series.

#include <string>
#include <vector>

#include "io/archive/archive.h"

namespace palpate::io {

/// An empty field matches anything. Texts are UTF-8; * and ? are the archive's wildcards.
struct ArchiveQuery {
  std::string patient;      ///< part of the name
  std::string patient_id;   ///< the whole id
  std::string date;         ///< YYYYMMDD, YYYYMMDD-YYYYMMDD, or a range open on one side
  std::string modality;     ///< CT, MR, ...
  std::string description;  ///< part of the study's description
  std::size_t most_studies = 100;
  bool with_series = true;
};

struct ArchivedSeries {
  std::string uid, modality, description;
  int number = 0;
  int images = 0;
};

struct ArchivedStudy {
  std::string uid, date, description, patient, patient_id;
  std::vector<ArchivedSeries> series;
};

struct Found {
  std::vector<ArchivedStudy> studies;  ///< the latest first
  bool more = false;                   ///< the archive holds more studies than were asked for
};

/// C-FIND, study root. Throws ArchiveError, and Cancelled if keep_going returns false.
Found find(const Archive& archive, const ArchiveQuery& query, const KeepGoing& keep_going = {});

/// The series of a study that was found without its series, by number. Throws as find() does.
std::vector<ArchivedSeries> find_series_of(const Archive& archive, const std::string& study_uid,
                                           const KeepGoing& keep_going = {});

/// A study, or one series of it.
struct Wanted {
  std::string study_uid;
  std::string series_uid;  ///< empty: the whole study
  int images = -1;         ///< number of images by the archive's count; -1: unknown
};

/// The study or series with a UID. Throws ArchiveError if the archive holds neither.
Wanted find_uid(const Archive& archive, const std::string& uid, const KeepGoing& keep_going = {});

}  // namespace palpate::io
