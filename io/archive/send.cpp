#include "io/archive/send.h"

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmdata/dctk.h>

#include <algorithm>

#include "io/archive/association.h"
#include "io/archive/status_words.h"
#include "io/dicom/dcmtk_start.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

struct Outgoing {
  std::filesystem::path file;
  std::string sop_class, instance, syntax;
  Text refused;
};

Outgoing look_at(const std::filesystem::path& file) {
  Outgoing result{file, "", "", "", {}};
  DcmFileFormat format;
  const OFCondition read = format.loadFile(file.c_str(), EXS_Unknown, EGL_noChange, 4096, ERM_fileOnly);
  OFString sop_class, instance;
  format.getDataset()->findAndGetOFString(DCM_SOPClassUID, sop_class);
  format.getDataset()->findAndGetOFString(DCM_SOPInstanceUID, instance);
  result.sop_class = sop_class.c_str();
  result.instance = instance.c_str();
  result.syntax = DcmXfer(format.getDataset()->getOriginalXfer()).getXferID();
  if (read.bad() || result.sop_class.empty() || result.instance.empty()) result.refused = say("cannot-be-sent");
  return result;
}

bool is_uncompressed(const std::string& syntax) {
  return std::ranges::count(uncompressed_syntaxes(), syntax) > 0;
}

std::vector<Proposal> proposals_for(const std::vector<Outgoing>& all) {
  std::vector<Proposal> proposals;
  for (const Outgoing& one : all) {
    if (!one.refused.empty()) continue;
    const Proposal proposal{
        one.sop_class, is_uncompressed(one.syntax) ? uncompressed_syntaxes() : std::vector<std::string>{one.syntax}};
    const bool there = std::ranges::any_of(proposals, [&](const Proposal& other) {
      return other.sop_class == proposal.sop_class && other.transfer_syntaxes == proposal.transfer_syntaxes;
    });
    if (!there) proposals.push_back(proposal);
  }
  return proposals;
}

/// The context in which a file goes as it is; uncompressed ones are converted between each other.
T_ASC_PresentationContextID context_of(Association& association, const Outgoing& one) {
  const char* sop_class = one.sop_class.c_str();
  const T_ASC_PresentationContextID exact =
      ASC_findAcceptedPresentationContextID(association.get(), sop_class, one.syntax.c_str());
  if (exact != 0 || !is_uncompressed(one.syntax)) return exact;
  for (const std::string& syntax : uncompressed_syntaxes()) {
    const T_ASC_PresentationContextID other =
        ASC_findAcceptedPresentationContextID(association.get(), sop_class, syntax.c_str());
    if (other != 0) return other;
  }
  return 0;
}

/// The archive's answer for a file.
struct Answer {
  bool taken = false;
  Text why;  ///< it was not taken, or was with a warning; else empty
};

Answer send_one(Association& association, const Outgoing& one, const KeepGoing& keep_going) {
  Command command;
  command.context = context_of(association, one);
  if (command.context == 0) {
    return {false, say("archive-does-not-take", association.archive().name,
                       dcmFindNameOfUID(one.sop_class.c_str(), one.sop_class.c_str()),
                       dcmFindNameOfUID(one.syntax.c_str(), one.syntax.c_str()))};
  }
  DcmFileFormat format;
  if (format.loadFile(one.file.c_str()).bad()) return {false, say("cannot-be-read-to-its-end")};
  command.message.CommandField = DIMSE_C_STORE_RQ;
  T_DIMSE_C_StoreRQ& request = command.message.msg.CStoreRQ;
  request.MessageID = association.next_message_id();
  request.Priority = DIMSE_PRIORITY_MEDIUM;
  request.DataSetType = DIMSE_DATASET_PRESENT;
  OFStandard::strlcpy(request.AffectedSOPClassUID, one.sop_class.c_str(), sizeof request.AffectedSOPClassUID);
  OFStandard::strlcpy(request.AffectedSOPInstanceUID, one.instance.c_str(), sizeof request.AffectedSOPInstanceUID);
  association.send(command, format.getDataset());
  const Command answer = association.receive(keep_going);
  if (answer.message.CommandField != DIMSE_C_STORE_RSP) {
    association.give_up();
    throw ArchiveError(say("archive-answered-a-file-with-something-else", association.archive().name));
  }
  const std::uint16_t status = answer.message.msg.CStoreRSP.DimseStatus;
  const std::string& name = association.archive().name;
  if (status == STATUS_Success) return {true, {}};
  if ((status & 0xF000U) == 0xB000U) return {true, say("archive-took-with-a-warning", name, status_words(status))};
  return {false, say("archive-did-not-take", name, status_words(status))};
}

}  // namespace

Sent send(const Archive& archive, const std::vector<std::filesystem::path>& files,
          const std::function<bool(std::size_t done)>& progress) {
  internal::start_dcmtk();
  std::vector<Outgoing> all;
  all.reserve(files.size());
  for (const std::filesystem::path& file : files) all.push_back(look_at(file));
  Sent sent;
  const std::vector<Proposal> proposals = proposals_for(all);
  if (proposals.empty()) {
    sent.not_sent.reserve(all.size());
    for (const Outgoing& one : all) sent.not_sent.push_back({one.file, one.refused});
    return sent;
  }
  Association association(archive, proposals);
  std::size_t done = 0;
  for (const Outgoing& one : all) {
    const auto keep_going = [&] { return !progress || progress(done); };
    if (!keep_going()) throw Cancelled();
    const Answer answer = one.refused.empty() ? send_one(association, one, keep_going) : Answer{false, one.refused};
    if (answer.taken) ++sent.files;
    if (!answer.why.empty()) (answer.taken ? sent.warned : sent.not_sent).push_back({one.file, answer.why});
    ++done;
  }
  return sent;
}

}  // namespace palpate::io
