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

/// An archive refused something, or could not be reached. The message uses the user's name of the archive and says
/// which setting to change. It never holds a patient's name or identifier.
class ArchiveError : public Refusal {
 public:
  using Refusal::Refusal;
};

/// Files in PEM format. The archive's certificate is checked against `authorities`, and must be for the archive's host.
/// The archive checks our certificate.
struct Tls {
  bool used = false;
  std::filesystem::path authorities;  ///< certificates trusted to sign the archive's
  std::filesystem::path certificate;  ///< ours; empty: we have none, and nothing can be sent to us by C-MOVE
  std::filesystem::path key;          ///< its private key, without a pass phrase
  std::string name;  ///< the machine that the archive's certificate is for, if that is not Archive::host

  bool operator==(const Tls&) const = default;
};

struct Archive {
  std::string name;  ///< what the user calls it
  std::string host;
  int port = 104;
  std::string called;                      ///< the archive's AE title, 1 to 16 characters
  std::string calling;                     ///< our AE title, as the archive knows us
  bool uses_get = false;                   ///< fetch with C-GET; false: with C-MOVE to our own storage service
  std::string listen_address = "0.0.0.0";  ///< IPv4 address on which we receive the images of C-MOVE
  int listen_port = 11112;                 ///< and the port; the archive must know both
  Tls tls;
  int silence_s = 30;  ///< s: give up after so long a silence of the archive

  bool operator==(const Archive&) const = default;
};

/// Throws ArchiveError that names a setting that is not valid.
void check(const Archive& archive);

/// C-ECHO: whether the archive answers and knows us. If not, throws ArchiveError that says why.
void echo(const Archive& archive);

/// Called several times a second, on the thread that called the function. If it returns false, the function throws
/// io::Cancelled.
using KeepGoing = std::function<bool()>;

}  // namespace palpate::io
