#include "io/archive/fetch.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>
#include <chrono>
#include <mutex>

#include "io/archive/association.h"
#include "io/archive/find.h"
#include "io/archive/inbox.h"
#include "io/archive/status_words.h"
#include "io/archive/store_server.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

constexpr std::size_t largest_count = 8U << 20U;  // bytes; an answer may list the UIDs that failed

/// How C-MOVE or C-GET ended: the last answer's counts.
struct Ended {
  std::uint16_t status = 0;
  int failed = 0;
  std::string which;  ///< SOP instances that failed, where it says so
};

DcmDataset keys_of(const Wanted& wanted) {
  DcmDataset keys;
  keys.putAndInsertString(DCM_QueryRetrieveLevel, wanted.series_uid.empty() ? "STUDY" : "SERIES");
  keys.putAndInsertString(DCM_StudyInstanceUID, wanted.study_uid.c_str());
  if (!wanted.series_uid.empty()) keys.putAndInsertString(DCM_SeriesInstanceUID, wanted.series_uid.c_str());
  return keys;
}

std::string words_of(const Wanted& wanted) {
  return wanted.series_uid.empty() ? "study " + wanted.study_uid : "series " + wanted.series_uid;
}

[[noreturn]] void refuse(const Archive& archive, const Wanted& wanted, const std::string& why) {
  throw ArchiveError(say("archive-did-not-send", archive.name, words_of(wanted), why));
}

/// Reports the progress to the watcher, not more often than a screen needs. Both the thread that fetches and the
/// connection's watch ask it.
class Teller {
 public:
  Teller(const FetchWatcher& watcher, const Inbox& inbox, int expected)
      : watcher_(watcher), inbox_(inbox), expected_(expected) {}
  bool operator()() {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ > std::chrono::milliseconds(50)) {
      last_ = now;
      tell_watcher();
    }
    return going_;
  }
  bool tell() {
    const std::lock_guard lock(mutex_);
    tell_watcher();
    return going_;
  }

 private:
  void tell_watcher() { going_ = going_ && (!watcher_ || watcher_({inbox_.files(), inbox_.bytes(), expected_})); }

  const FetchWatcher& watcher_;
  const Inbox& inbox_;
  int expected_;
  std::mutex mutex_;
  bool going_ = true;
  std::chrono::steady_clock::time_point last_{};
};

/// The instances that an answer says could not be sent, in a few words.
std::string failed_instances(Association& association, const Command& command, T_DIMSE_DataSetType type) {
  if (type == DIMSE_DATASET_NULL) return {};
  OFString list;
  association.receive_dataset(command.context, largest_count)
      ->findAndGetOFStringArray(DCM_FailedSOPInstanceUIDList, list);
  std::string words = list.c_str();
  std::ranges::replace(words, '\\', ' ');
  constexpr std::size_t most = 200;  // three or so
  if (words.size() > most) words = words.substr(0, words.rfind(' ', most)) + " ...";
  std::ranges::replace_if(
      words, [](char c) { return c < ' ' || c > '~'; }, '?');
  return words;
}

Ended move(const Archive& archive, const Wanted& wanted, Inbox& inbox, Teller& teller, std::string& turned_away) {
  constexpr const char* model = UID_MOVEStudyRootQueryRetrieveInformationModel;
  StoreServer server(archive, inbox);
  Association association(archive, {{model, uncompressed_syntaxes()}});
  Command ask;
  T_DIMSE_C_MoveRQ& request = ask.message.msg.CMoveRQ;
  OFStandard::strlcpy(request.MoveDestination, archive.calling.c_str(), sizeof request.MoveDestination);
  DcmDataset keys = keys_of(wanted);
  send_request(association, model, DIMSE_C_MOVE_RQ, ask, request, keys);
  std::uint64_t seen = 0;
  const KeepGoing keep_going = [&] {
    // It is silent here while it sends there.
    if (inbox.received_bytes() != seen) association.watch().heard();
    seen = inbox.received_bytes();
    server.rethrow();
    return teller();
  };
  try {
    while (true) {
      const Command command = association.receive(keep_going);
      if (command.message.CommandField != DIMSE_C_MOVE_RSP)
        refuse(archive, wanted, say("answered-with-something-else"));
      const T_DIMSE_C_MoveRSP& answer = command.message.msg.CMoveRSP;
      const std::string which = failed_instances(association, command, answer.DataSetType);
      server.rethrow();
      if (!teller()) throw Cancelled();
      if (answer.DimseStatus != STATUS_Pending) {
        turned_away = server.turned_away();
        return {answer.DimseStatus, answer.NumberOfFailedSubOperations, which};
      }
    }
  } catch (...) {
    association.give_up();
    throw;
  }
}

std::vector<Proposal> proposals_for_get() {
  std::vector<Proposal> proposals = {{UID_GETStudyRootQueryRetrieveInformationModel, uncompressed_syntaxes()}};
  // A separate context for each encoding: the archive chooses one encoding for each context, and some archives send
  // only the encoding in which they store an image.
  for (const char* kind : {UID_CTImageStorage, UID_MRImageStorage, UID_EnhancedCTImageStorage,
                           UID_EnhancedMRImageStorage, UID_PositronEmissionTomographyImageStorage}) {
    proposals.push_back({kind, uncompressed_syntaxes(), true});
    for (const std::string& syntax : compressed_syntaxes()) proposals.push_back({kind, {syntax}, true});
  }
  for (const char* kind :
       {UID_SegmentationStorage, UID_RTStructureSetStorage, UID_LegacyConvertedEnhancedCTImageStorage,
        UID_LegacyConvertedEnhancedMRImageStorage, UID_LegacyConvertedEnhancedPETImageStorage,
        UID_EnhancedPETImageStorage, UID_SecondaryCaptureImageStorage, UID_XRay3DAngiographicImageStorage,
        UID_BasicTextSRStorage, UID_EnhancedSRStorage, UID_ComprehensiveSRStorage, UID_Comprehensive3DSRStorage,
        UID_ParametricMapStorage, UID_SpatialRegistrationStorage, UID_SurfaceSegmentationStorage,
        UID_UltrasoundImageStorage, UID_NuclearMedicineImageStorage, UID_RTDoseStorage,
        UID_XRayRadiationDoseSRStorage}) {
    proposals.push_back({kind, uncompressed_syntaxes(), true});
  }
  return proposals;
}

Ended get(const Archive& archive, const Wanted& wanted, Inbox& inbox, Teller& teller) {
  constexpr const char* model = UID_GETStudyRootQueryRetrieveInformationModel;
  Association association(archive, proposals_for_get());
  Command ask;
  DcmDataset keys = keys_of(wanted);
  send_request(association, model, DIMSE_C_GET_RQ, ask, ask.message.msg.CGetRQ, keys);
  const KeepGoing keep_going = [&] { return teller(); };
  const Watch::Asking asking(association.watch(), keep_going);
  try {
    while (true) {
      Command command = association.receive(keep_going);
      if (command.message.CommandField == DIMSE_C_STORE_RQ) {
        OFCondition broken;
        const T_DIMSE_C_StoreRQ& stored = command.message.msg.CStoreRQ;
        Command answer;
        answer.context = command.context;
        answer.message.CommandField = DIMSE_C_STORE_RSP;
        T_DIMSE_C_StoreRSP& response = answer.message.msg.CStoreRSP;
        response.DimseStatus =
            inbox.store(*association.get(), association.watch(), archive.silence_s, command, keep_going, broken);
        if (broken.bad()) {
          if (association.watch().cancelled()) throw Cancelled();
          refuse(archive, wanted, say("connection-broke-after-images", inbox.files()));
        }
        response.MessageIDBeingRespondedTo = stored.MessageID;
        response.DataSetType = DIMSE_DATASET_NULL;
        response.opts = O_STORE_AFFECTEDSOPCLASSUID | O_STORE_AFFECTEDSOPINSTANCEUID;
        OFStandard::strlcpy(response.AffectedSOPClassUID, stored.AffectedSOPClassUID,
                            sizeof response.AffectedSOPClassUID);
        OFStandard::strlcpy(response.AffectedSOPInstanceUID, stored.AffectedSOPInstanceUID,
                            sizeof response.AffectedSOPInstanceUID);
        association.send(answer);
      } else if (command.message.CommandField == DIMSE_C_GET_RSP) {
        const T_DIMSE_C_GetRSP& answer = command.message.msg.CGetRSP;
        const std::string which = failed_instances(association, command, answer.DataSetType);
        if (answer.DimseStatus != STATUS_Pending) {
          return {answer.DimseStatus, answer.NumberOfFailedSubOperations, which};
        }
      } else {
        refuse(archive, wanted, say("answered-with-something-else"));
      }
    }
  } catch (...) {
    association.give_up();
    throw;
  }
}

/// Interprets the last answer for the user. Throws ArchiveError if nothing is worth keeping.
void judge(const Archive& archive, const Wanted& wanted, const Ended& ended, std::size_t came, std::size_t unasked,
           const std::string& turned_away, Fetched& result) {
  const Text destination = say("enter-the-destination", archive.calling, archive.listen_port);
  if (ended.status == 0xA801) refuse(archive, wanted, say("not-a-known-destination", destination));
  const bool partly = ended.status == STATUS_Success || ended.status == 0xB000 || ended.failed > 0;
  if (!partly) refuse(archive, wanted, status_words(ended.status));
  if (came == 0 && unasked > 0) {
    refuse(archive, wanted, say("sent-something-else"));
  }
  if (came == 0 && !turned_away.empty()) {
    refuse(archive, wanted, say("turned-away", turned_away));
  }
  if (came == 0 && archive.uses_get) {
    refuse(archive, wanted, ended.failed > 0 ? say("all-images-failed", ended.failed) : say("archive-has-no-images"));
  }
  if (came == 0) {
    refuse(archive, wanted, say("nothing-arrived-here", destination));
  }
  if (ended.failed > 0) {
    result.complete = false;
    result.warnings.push_back(say("some-images-failed", ended.failed, came + static_cast<std::size_t>(ended.failed),
                                  words_of(wanted), archive.name, ended.which.empty() ? "" : " (" + ended.which + ")"));
  }
  if (unasked > 0) {
    result.warnings.push_back(say("archive-also-sent-objects-that-were-not", archive.name, unasked));
  }
}

/// A series may grow while it is fetched. What came is kept where the archive does not answer this.
void warn_of_growth(const Archive& archive, const Wanted& wanted, std::size_t came, const KeepGoing& keep_going,
                    std::vector<Text>& warnings) {
  const std::string& uid = wanted.series_uid.empty() ? wanted.study_uid : wanted.series_uid;
  int now = -1;
  try {
    now = find_uid(archive, uid, keep_going).images;
  } catch (const ArchiveError&) {
    return;
  }
  if (now > static_cast<int>(came)) {
    warnings.push_back(say("archive-now-holds-images", archive.name, now, words_of(wanted), came));
  }
}

}  // namespace

Fetched fetch(const Archive& archive, const std::vector<std::string>& uids, const std::filesystem::path& folder,
              const FetchLimits& limits, const FetchWatcher& watcher) {
  std::vector<Wanted> all;
  all.reserve(uids.size());
  Inbox inbox(folder, limits);
  Teller asking(watcher, inbox, -1);
  const KeepGoing keep_going = [&] { return asking(); };
  int expected = 0;
  for (const std::string& uid : uids) {
    all.push_back(find_uid(archive, uid, keep_going));
    expected = all.back().images < 0 || expected < 0 ? -1 : expected + all.back().images;
  }
  Fetched result;
  Teller teller(watcher, inbox, expected);
  for (const Wanted& wanted : all) {
    const std::size_t unasked_before = inbox.unasked();
    std::string turned_away;
    inbox.expect(wanted);
    const Ended ended =
        archive.uses_get ? get(archive, wanted, inbox, teller) : move(archive, wanted, inbox, teller, turned_away);
    if (!teller.tell()) throw Cancelled();
    const std::size_t came = inbox.came();
    judge(archive, wanted, ended, came, inbox.unasked() - unasked_before, turned_away, result);
    if (ended.failed == 0) warn_of_growth(archive, wanted, came, keep_going, result.warnings);
  }
  result.files = inbox.files();
  result.bytes = inbox.bytes();
  result.series = inbox.finish();
  return result;
}

}  // namespace palpate::io
