#pragma once

/// A real archive for tests: Debian's Orthanc, started on this machine with an empty store and stopped by the
/// destructor.

#include <filesystem>
#include <memory>

#include "io/archive/archive.h"
#include "io/archive/testing/process.h"

namespace palpate::io::testing {

/// Empty if Orthanc is not installed.
std::filesystem::path orthanc_program();

/// Certificates of a test authority, made with openssl: authority.pem, and for `archive` and `palpate` a .pem and a
/// .key. The archive's is for 127.0.0.1 and pacs.example, ours for workstation.example. False if openssl is missing.
bool make_certificates(const std::filesystem::path& folder);

class Orthanc {
 public:
  /// All its files are in `folder`, which is made. Uses TLS if `certificates` is given. Throws std::runtime_error with
  /// Orthanc's log if it does not start.
  explicit Orthanc(const std::filesystem::path& folder, const std::filesystem::path& certificates = {});

  /// The settings to reach it. It knows us as PALPATE and sends to our port.
  const Archive& archive() const noexcept { return archive_; }

 private:
  Archive archive_;
  std::unique_ptr<Process> process_;
};

}  // namespace palpate::io::testing
