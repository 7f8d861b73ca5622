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

/// An archive refused a request, or could not be reached. The message names the archive as the user does, and says
/// which setting to change. It never holds a patient's name or identifier.
class ArchiveError : public Refusal {
 public:
  using Refusal::Refusal;
};

/// Files in PEM. The archive's certificate is checked against `authorities`, and must be for the archive's host. Ours
/// is sent to the archive.
struct Tls {
  bool used = false;
  std::filesystem::path authorities;  ///< authorities (CAs) whose signature on the archive's certificate is trusted
  std::filesystem::path certificate;  ///< ours; empty: none is sent, and the archive cannot send to us by C-MOVE
  std::filesystem::path key;          ///< its private key, without a pass phrase
  std::string name;                   ///< host name in the archive's certificate, if it is not Archive::host

  bool operator==(const Tls&) const = default;
};

struct Archive {
  std::string name;  ///< the user's name for it
  std::string host;
  int port = 104;
  std::string called;                      ///< the archive's AE title, 1 to 16 characters
  std::string calling;                     ///< our AE title, as the archive knows us
  bool uses_get = false;                   ///< fetch with C-GET; false: with C-MOVE to our own storage service
  std::string listen_address = "0.0.0.0";  ///< IPv4 address of our storage service for C-MOVE
  int listen_port = 11112;                 ///< port of our storage service; the archive has to know address and port
  Tls tls;
  int silence_s = 30;  ///< s: give up if the archive is silent for this long

  bool operator==(const Archive&) const = default;
};

/// Throws ArchiveError that names a setting that is not valid.
void check(const Archive& archive);

/// C-ECHO: checks that the archive answers and accepts our AE title. Throws ArchiveError with the reason if not.
void echo(const Archive& archive);

/// Called about once a second, on the thread that called the function. If it returns false, the function throws
/// io::Cancelled.
using KeepGoing = std::function<bool()>;

}  // namespace palpate::io
