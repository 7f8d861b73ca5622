#pragma once

/// An association with an archive, as the one who asks for it. What the files of this folder share; not installed.

#include <dcmtk/config/osconfig.h>
// DCMTK's configuration comes first.
#include <dcmtk/dcmnet/dimse.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/archive/archive.h"
#include "io/archive/transport.h"

namespace palpate::io {

/// A kind of object (SOP class) and the encodings (transfer syntaxes) that are offered for it, the best first.
struct Proposal {
  std::string sop_class;
  std::vector<std::string> transfer_syntaxes;
  bool we_receive = false;  ///< the archive sends these to us on the same association (C-GET)
};

/// A command that came, with the presentation context it came in.
struct Command {
  T_DIMSE_Message message{};
  T_ASC_PresentationContextID context = 0;
};

class Association {
 public:
  /// Throws ArchiveError saying why there is none and what to set where.
  Association(const Archive& archive, const std::vector<Proposal>& proposals);
  Association(const Association&) = delete;
  Association& operator=(const Association&) = delete;
  /// Released in good order, or aborted where something went wrong on it.
  ~Association();

  T_ASC_Association* get() const noexcept { return association_; }
  const Archive& archive() const noexcept { return archive_; }
  std::uint16_t next_message_id() noexcept { return association_->nextMsgID++; }

  /// The context that was agreed on for a kind of object. Throws ArchiveError where there is none.
  T_ASC_PresentationContextID context_for(const std::string& sop_class) const;
  bool accepts(const std::string& sop_class) const;

  /// Sends a command, with a dataset where one is given. Throws ArchiveError.
  void send(Command& command, DcmDataset* dataset = nullptr);
  /// The next command. Throws Cancelled where keep_going says so (asked at least once a second), ArchiveError where
  /// the archive goes away or is silent for too long.
  Command receive(const KeepGoing& keep_going);
  /// The dataset that follows a command, at most `most_bytes` of it. Throws ArchiveError.
  std::unique_ptr<DcmDataset> receive_dataset(T_ASC_PresentationContextID context, std::size_t most_bytes);
  /// From here on it can only be aborted.
  void give_up() noexcept { broken_ = true; }
  /// Tells the watch that something is heard, where others read from it.
  Watch& watch() noexcept { return *watch_; }

 private:
  [[noreturn]] void fail(const OFCondition& condition);

  const Archive& archive_;
  std::unique_ptr<Transport> transport_;
  T_ASC_Network* network_ = nullptr;
  T_ASC_Association* association_ = nullptr;
  std::unique_ptr<Watch> watch_;
  bool broken_ = false;
};

/// Asks a question of the study-root model `model` (a SOP class): sends the keys in its context. `field` is the kind of
/// command, and `request` the part of `command` for it, where the rest has been filled in. Throws ArchiveError.
template <typename Request>
void send_request(Association& association, const char* model, T_DIMSE_Command field, Command& command,
                  Request& request, DcmDataset& keys) {
  command.context = association.context_for(model);
  command.message.CommandField = field;
  request.MessageID = association.next_message_id();
  request.Priority = DIMSE_PRIORITY_MEDIUM;
  request.DataSetType = DIMSE_DATASET_PRESENT;
  OFStandard::strlcpy(request.AffectedSOPClassUID, model, sizeof request.AffectedSOPClassUID);
  association.send(command, &keys);
}

/// Uncompressed encodings, the best first.
const std::vector<std::string>& uncompressed_syntaxes();
/// Compressed encodings that can be read.
const std::vector<std::string>& compressed_syntaxes();

/// Bytes of the dataset that follows a command, as they come; false from the sink ends it, and then the association
/// can only be aborted.
OFCondition stream_dataset(T_ASC_Association& association, int silence_s, Watch& watch,
                           const std::function<bool(const void*, std::size_t)>& sink);

}  // namespace palpate::io
