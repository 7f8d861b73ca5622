#pragma once

/// The settings of an archive (PACS) that is reached with DICOM over the network, and its verification. The standard:
/// DICOM PS3.4 Annex C (query and retrieve, study root), Annex B (storage), Annex A (verification).

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>

#include "solver/text/message.h"

namespace palpate::io {

/// An archive refused something, or could not be reached. The message names the archive as the user does and says what
/// to set where. It never holds a patient's name or identifier.
class ArchiveError : public Refusal {
 public:
  using Refusal::Refusal;
};

/// Files in PEM. The archive's certificate is checked against `authorities`, and has to be for the archive's host; ours
/// is shown to it.
struct Tls {
  bool used = false;
  std::filesystem::path authorities;  ///< certificates trusted to sign the archive's
  std::filesystem::path certificate;  ///< ours; empty: none is shown, and nothing can be sent to us by C-MOVE
  std::filesystem::path key;          ///< its private key, without a pass phrase
  std::string name;  ///< the machine that the archive's certificate is for, where it is not Archive::host

  bool operator==(const Tls&) const = default;
};

struct Archive {
  std::string name;  ///< what the user calls it
  std::string host;
  int port = 104;
  std::string called;                      ///< the archive's AE title, 1 to 16 characters
  std::string calling;                     ///< our AE title, as the archive knows us
  bool uses_get = false;                   ///< fetch with C-GET; false: with C-MOVE to our own storage service
  std::string listen_address = "0.0.0.0";  ///< IPv4 address on which C-MOVE's images are awaited
  int listen_port = 11112;                 ///< and the port; both have to be known to the archive
  Tls tls;
  int silence_s = 30;  ///< s: give up where the archive says nothing for so long

  bool operator==(const Archive&) const = default;
};

/// Throws ArchiveError naming a setting that is not valid.
void check(const Archive& archive);

/// C-ECHO: whether the archive answers and knows us. Throws ArchiveError saying why not.
void echo(const Archive& archive);

/// Called now and then, on the thread that called the function. If it returns false, the function throws io::Cancelled.
using KeepGoing = std::function<bool()>;

}  // namespace palpate::io
