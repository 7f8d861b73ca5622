#pragma once

/// An association with an archive, on the requestor's side. Shared by the files of this folder; not installed.

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

/// A command that was received, and its presentation context.
struct Command {
  T_DIMSE_Message message{};
  T_ASC_PresentationContextID context = 0;
};

class Association {
 public:
  /// If there is none, throws ArchiveError that says why, and which setting to change.
  Association(const Archive& archive, const std::vector<Proposal>& proposals);
  Association(const Association&) = delete;
  Association& operator=(const Association&) = delete;
  /// Releases the association, or aborts it after an error.
  ~Association();

  T_ASC_Association* get() const noexcept { return association_; }
  const Archive& archive() const noexcept { return archive_; }
  std::uint16_t next_message_id() noexcept { return association_->nextMsgID++; }

  /// The context that was accepted for a kind of object. Throws ArchiveError if none was.
  T_ASC_PresentationContextID context_for(const std::string& sop_class) const;
  bool accepts(const std::string& sop_class) const;

  /// Sends a command, and its dataset if there is one. Throws ArchiveError.
  void send(Command& command, DcmDataset* dataset = nullptr);
  /// The next command. Throws Cancelled if keep_going returns false (called at least once a second), and ArchiveError
  /// if the archive closes the connection or is silent for too long.
  Command receive(const KeepGoing& keep_going);
  /// The dataset that follows a command, at most `most_bytes` of it. Throws ArchiveError.
  std::unique_ptr<DcmDataset> receive_dataset(T_ASC_PresentationContextID context, std::size_t most_bytes);
  /// From now on the association can only be aborted.
  void give_up() noexcept { broken_ = true; }
  /// Tells the watch that data has come, for code that reads from the association directly.
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

/// Sends a query of the study-root model `model` (a SOP class) with its keys. `field`: the kind of command. `request`:
/// the part of `command` for that kind, whose other fields have been filled in. Throws ArchiveError.
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
/// Compressed encodings that we can decode.
const std::vector<std::string>& compressed_syntaxes();

/// Passes on the bytes of the dataset that follows a command as they arrive. If the sink returns false, reading ends,
/// and the association can only be aborted.
OFCondition stream_dataset(T_ASC_Association& association, int silence_s, Watch& watch,
                           const std::function<bool(const void*, std::size_t)>& sink);

}  // namespace palpate::io
