#pragma once

/// An association that we request from an archive. Shared by the files of this folder; not installed.

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

/// A kind of object (SOP class) and the encodings (transfer syntaxes) proposed for it, the preferred one first.
struct Proposal {
  std::string sop_class;
  std::vector<std::string> transfer_syntaxes;
  bool we_receive = false;  ///< the archive sends these to us on the same association (C-GET)
};

/// A received command, and its presentation context.
struct Command {
  T_DIMSE_Message message{};
  T_ASC_PresentationContextID context = 0;
};

class Association {
 public:
  /// Throws ArchiveError with the reason and the setting to change.
  Association(const Archive& archive, const std::vector<Proposal>& proposals);
  Association(const Association&) = delete;
  Association& operator=(const Association&) = delete;
  /// Releases the association, or aborts it if it has failed.
  ~Association();

  T_ASC_Association* get() const noexcept { return association_; }
  const Archive& archive() const noexcept { return archive_; }
  std::uint16_t next_message_id() noexcept { return association_->nextMsgID++; }

  /// The accepted presentation context of a SOP class. Throws ArchiveError if there is none.
  T_ASC_PresentationContextID context_for(const std::string& sop_class) const;
  bool accepts(const std::string& sop_class) const;

  /// Sends a command, and a dataset if one is given. Throws ArchiveError.
  void send(Command& command, DcmDataset* dataset = nullptr);
  /// The next command. Throws Cancelled if keep_going returns false (it is called at least once a second), and
  /// ArchiveError if the connection ends or the archive is silent for too long.
  Command receive(const KeepGoing& keep_going);
  /// The dataset that follows a command, at most `most_bytes` of it. Throws ArchiveError.
  std::unique_ptr<DcmDataset> receive_dataset(T_ASC_PresentationContextID context, std::size_t most_bytes);
  /// After this the association can only be aborted.
  void give_up() noexcept { broken_ = true; }
  /// The watch of this connection, for code that reads from the connection itself: it has to report what it receives.
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

/// Sends a request with keys in the study-root model `model` (a SOP class). `field` is the type of the command, and
/// `request` its part of `command`; the caller has filled in the rest. Throws ArchiveError.
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

/// Uncompressed encodings, the preferred one first.
const std::vector<std::string>& uncompressed_syntaxes();
/// Compressed encodings that we can decode.
const std::vector<std::string>& compressed_syntaxes();

/// Passes the bytes of the dataset that follows a command to `sink` as they arrive. If the sink returns false, reading
/// stops, and the association can only be aborted.
OFCondition stream_dataset(T_ASC_Association& association, int silence_s, Watch& watch,
                           const std::function<bool(const void*, std::size_t)>& sink);

}  // namespace palpate::io
