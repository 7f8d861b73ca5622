#include "io/archive/find.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <cstdlib>

#include "io/archive/association.h"
#include "io/archive/status_words.h"
#include "io/dicom/character_set.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr std::size_t largest_answer = 1U << 20U;  // bytes; an answer is a few hundred
constexpr const char* model = UID_FINDStudyRootQueryRetrieveInformationModel;

bool is_pending(std::uint16_t status) {
  return status == STATUS_Pending || status == STATUS_FIND_Pending_WarningUnsupportedOptionalKeys;
}

std::string text_of(DcmItem& item, const DcmTagKey& key) {
  OFString value, set;
  item.findAndGetOFStringArray(key, value);
  item.findAndGetOFStringArray(DCM_SpecificCharacterSet, set);
  std::string text = internal::utf8_of(value.c_str(), set.c_str());
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

int number_of(DcmItem& item, const DcmTagKey& key, int otherwise) {
  const std::string text = text_of(item, key);
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  return end == text.c_str() ? otherwise : static_cast<int>(std::clamp(value, -1L, 100000000L));
}

void put(DcmItem& item, const DcmTagKey& key, const std::string& value) {
  item.putAndInsertString(key, value.c_str());
}

void send_cancel(Association& association, const Command& asked) {
  Command stop;
  stop.context = asked.context;
  stop.message.CommandField = DIMSE_C_CANCEL_RQ;
  stop.message.msg.CCancelRQ.MessageIDBeingRespondedTo = asked.message.msg.CFindRQ.MessageID;
  stop.message.msg.CCancelRQ.DataSetType = DIMSE_DATASET_NULL;
  association.send(stop);
}

struct Answers {
  std::vector<std::unique_ptr<DcmDataset>> items;
  bool more = false;
};

/// One question, and all that is answered to it, up to `most`.
Answers ask(Association& association, DcmDataset& keys, std::size_t most, const KeepGoing& keep_going) {
  Command question;
  send_request(association, model, DIMSE_C_FIND_RQ, question, question.message.msg.CFindRQ, keys);
  Answers answers;
  while (true) {
    const Command command = association.receive(keep_going);
    if (command.message.CommandField != DIMSE_C_FIND_RSP) {
      association.give_up();
      throw ArchiveError(say("archive-answered-a-question-with-something-else", association.archive().name));
    }
    const T_DIMSE_C_FindRSP& answer = command.message.msg.CFindRSP;
    std::unique_ptr<DcmDataset> item;
    if (answer.DataSetType != DIMSE_DATASET_NULL) item = association.receive_dataset(command.context, largest_answer);
    if (!is_pending(answer.DimseStatus)) {
      if (answer.DimseStatus != STATUS_Success && !(answers.more && answer.DimseStatus == 0xFE00)) {
        throw ArchiveError(
            say("archive-refused-the-question", association.archive().name, status_words(answer.DimseStatus)));
      }
      return answers;
    }
    if (item == nullptr) continue;
    if (answers.items.size() < most) {
      answers.items.push_back(std::move(item));
    } else if (!answers.more) {
      answers.more = true;
      send_cancel(association, question);
    }
  }
}

/// Part of a text, as an archive matches it.
std::string part(const std::string& text) {
  return text.empty() || text.find_first_of("*?") != std::string::npos ? text : "*" + text + "*";
}

void set_character_set(DcmDataset& keys, const ArchiveQuery& query) {
  const auto plain = [](const std::string& text) {
    return std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 128; });
  };
  if (!plain(query.patient) || !plain(query.patient_id) || !plain(query.description)) {
    put(keys, DCM_SpecificCharacterSet, "ISO_IR 192");
  }
}

constexpr std::size_t most_series = 10000;

std::vector<ArchivedSeries> series_of(Association& association, const std::string& study, const std::string& modality,
                                      const KeepGoing& keep_going) {
  DcmDataset keys;
  put(keys, DCM_QueryRetrieveLevel, "SERIES");
  put(keys, DCM_StudyInstanceUID, study);
  put(keys, DCM_Modality, modality);
  for (const DcmTagKey& key :
       {DCM_SeriesInstanceUID, DCM_SeriesNumber, DCM_SeriesDescription, DCM_NumberOfSeriesRelatedInstances}) {
    keys.insertEmptyElement(key);
  }
  std::vector<ArchivedSeries> result;
  for (const auto& item : ask(association, keys, most_series, keep_going).items) {
    ArchivedSeries series;
    series.uid = text_of(*item, DCM_SeriesInstanceUID);
    series.modality = text_of(*item, DCM_Modality);
    series.description = text_of(*item, DCM_SeriesDescription);
    series.number = number_of(*item, DCM_SeriesNumber, 0);
    series.images = number_of(*item, DCM_NumberOfSeriesRelatedInstances, -1);
    result.push_back(series);
  }
  std::ranges::stable_sort(result, {}, &ArchivedSeries::number);
  return result;
}

/// For archives that do not say how many images a series has.
int count_images(Association& association, const std::string& study, const std::string& series,
                 const KeepGoing& keep_going) {
  DcmDataset keys;
  put(keys, DCM_QueryRetrieveLevel, "IMAGE");
  put(keys, DCM_StudyInstanceUID, study);
  put(keys, DCM_SeriesInstanceUID, series);
  keys.insertEmptyElement(DCM_SOPInstanceUID);
  return static_cast<int>(ask(association, keys, 1000000, keep_going).items.size());
}

std::vector<ArchivedSeries> counted_series_of(Association& association, const std::string& study,
                                              const std::string& modality, const KeepGoing& keep_going) {
  std::vector<ArchivedSeries> all = series_of(association, study, modality, keep_going);
  for (ArchivedSeries& series : all) {
    if (series.images < 0) series.images = count_images(association, study, series.uid, keep_going);
  }
  return all;
}

DcmDataset study_keys(const ArchiveQuery& query) {
  DcmDataset keys;
  set_character_set(keys, query);
  put(keys, DCM_QueryRetrieveLevel, "STUDY");
  put(keys, DCM_PatientName, part(query.patient));
  put(keys, DCM_PatientID, query.patient_id);
  put(keys, DCM_StudyDate, query.date);
  put(keys, DCM_ModalitiesInStudy, query.modality);
  put(keys, DCM_StudyDescription, part(query.description));
  keys.insertEmptyElement(DCM_StudyInstanceUID);
  return keys;
}

void check_date(const std::string& date) {
  const auto day = [](const std::string& text) {
    return text.size() == 8 && text.find_first_not_of("0123456789") == std::string::npos;
  };
  const std::size_t dash = date.find('-');
  const bool good = date.empty() || (dash == std::string::npos && day(date)) ||
                    (dash != std::string::npos && date.size() > 1 && (dash == 0 || day(date.substr(0, dash))) &&
                     (dash + 1 == date.size() || day(date.substr(dash + 1))));
  if (!good) throw ArchiveError(say("date-has-to-be-yyyymmdd"));
}

void check_uid(const std::string& uid) {
  if (uid.empty() || uid.size() > 64 || uid.find_first_not_of("0123456789.") != std::string::npos) {
    throw ArchiveError(say("no-uid", printable(uid)));
  }
}

}  // namespace

Found find(const Archive& archive, const ArchiveQuery& query, const KeepGoing& keep_going) {
  check_date(query.date);
  Association association(archive, {{model, uncompressed_syntaxes()}});
  DcmDataset keys = study_keys(query);
  Answers answers = ask(association, keys, query.most_studies, keep_going);
  Found found{{}, answers.more};
  for (const auto& item : answers.items) {
    ArchivedStudy study;
    study.uid = text_of(*item, DCM_StudyInstanceUID);
    study.date = text_of(*item, DCM_StudyDate);
    study.description = text_of(*item, DCM_StudyDescription);
    study.patient = text_of(*item, DCM_PatientName);
    study.patient_id = text_of(*item, DCM_PatientID);
    if (query.with_series) {
      study.series = counted_series_of(association, study.uid, query.modality, keep_going);
    }
    found.studies.push_back(std::move(study));
  }
  std::ranges::stable_sort(found.studies, std::greater<>(), &ArchivedStudy::date);
  return found;
}

std::vector<ArchivedSeries> find_series_of(const Archive& archive, const std::string& study_uid,
                                           const KeepGoing& keep_going) {
  check_uid(study_uid);
  Association association(archive, {{model, uncompressed_syntaxes()}});
  return counted_series_of(association, study_uid, "", keep_going);
}

Wanted find_uid(const Archive& archive, const std::string& uid, const KeepGoing& keep_going) {
  check_uid(uid);
  Association association(archive, {{model, uncompressed_syntaxes()}});
  DcmDataset studies;
  put(studies, DCM_QueryRetrieveLevel, "STUDY");
  put(studies, DCM_StudyInstanceUID, uid);
  studies.insertEmptyElement(DCM_NumberOfStudyRelatedInstances);
  const Answers as_study = ask(association, studies, 1, keep_going);
  if (!as_study.items.empty()) {
    return {uid, "", number_of(*as_study.items.front(), DCM_NumberOfStudyRelatedInstances, -1)};
  }
  DcmDataset series;
  put(series, DCM_QueryRetrieveLevel, "SERIES");
  series.insertEmptyElement(DCM_StudyInstanceUID);
  put(series, DCM_SeriesInstanceUID, uid);
  series.insertEmptyElement(DCM_NumberOfSeriesRelatedInstances);
  for (const auto& item : ask(association, series, 1, keep_going).items) {
    const std::string study = text_of(*item, DCM_StudyInstanceUID);
    if (!study.empty()) return {study, uid, number_of(*item, DCM_NumberOfSeriesRelatedInstances, -1)};
  }
  throw ArchiveError(say("archive-holds-no-study-and-no-series", archive.name, uid));
}

}  // namespace palpate::io
