#include "io/archive/testing/orthanc.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace palpate::io::testing {

namespace fs = std::filesystem;

fs::path orthanc_program() {
  for (const char* place : {"/usr/sbin/Orthanc", "/usr/bin/Orthanc", "/usr/local/sbin/Orthanc"}) {
    if (fs::exists(place)) return place;
  }
  return {};
}

bool make_certificates(const fs::path& folder) {
  fs::create_directories(folder);
  const std::string make =
      "cd '" + folder.string() +
      "' && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=authority "
      "-keyout authority.key -out "
      "authority.pem && printf 'subjectAltName=IP:127.0.0.1,DNS:pacs.example' > archive.ext && "
      "printf 'subjectAltName=DNS:workstation.example' > palpate.ext && for who in archive palpate; do "
      "openssl req -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -subj /CN=$who -keyout "
      "$who.key -out $who.csr && openssl x509 -req -days 2 -in $who.csr -CA authority.pem -CAkey authority.key "
      "-CAcreateserial -extfile $who.ext -out $who.pem || exit 1; done";
  return std::system(("{ " + make + "; } >/dev/null 2>&1").c_str()) == 0;
}

Orthanc::Orthanc(const fs::path& folder, const fs::path& certificates) {
  fs::create_directories(folder / "store");
  const bool tls = !certificates.empty();
  archive_.name = "orthanc";
  archive_.host = "127.0.0.1";
  archive_.port = free_port();
  archive_.called = "ORTHANC";
  archive_.calling = "PALPATE";
  archive_.listen_address = "127.0.0.1";
  archive_.listen_port = free_port();
  archive_.silence_s = 10;
  nlohmann::json us{{"AET", "PALPATE"}, {"Host", "127.0.0.1"}, {"Port", archive_.listen_port}};
  if (tls) us["UseDicomTls"] = true;
  nlohmann::json settings{{"Name", "for tests"},
                          {"StorageDirectory", (folder / "store").string()},
                          {"IndexDirectory", (folder / "store").string()},
                          {"HttpServerEnabled", false},
                          {"DicomServerEnabled", true},
                          {"DicomAet", "ORTHANC"},
                          {"DicomPort", archive_.port},
                          {"DicomCheckCalledAet", true},
                          {"DicomAlwaysAllowEcho", false},
                          {"DicomAlwaysAllowStore", false},
                          {"DicomAlwaysAllowFind", false},
                          {"DicomAlwaysAllowGet", false},
                          {"DicomAlwaysAllowMove", false},
                          {"DicomModalities", {{"palpate", us}}},
                          {"OverwriteInstances", true},
                          {"StableAge", 1},
                          {"Plugins", nlohmann::json::array()}};
  if (tls) {
    settings["DicomTlsEnabled"] = true;
    settings["DicomTlsCertificate"] = (certificates / "archive.pem").string();
    settings["DicomTlsPrivateKey"] = (certificates / "archive.key").string();
    settings["DicomTlsTrustedCertificates"] = (certificates / "authority.pem").string();
    archive_.tls = {true, certificates / "authority.pem", certificates / "palpate.pem", certificates / "palpate.key",
                    ""};
  }
  std::ofstream(folder / "orthanc.json") << settings.dump(1);
  const fs::path log = folder / "orthanc.log";
  process_ = std::make_unique<Process>(
      // Debian's DCMTK waits for more to send otherwise, 40 ms a message.
      std::vector<std::string>{"env", "TCP_NODELAY=1", orthanc_program().string(), (folder / "orthanc.json").string()},
      log);
  for (int n = 0; n < 1000; ++n) {
    if (is_listening(archive_.port)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::stringstream said;
  said << std::ifstream(log).rdbuf();
  throw std::runtime_error("Orthanc did not start:\n" + said.str());
}

}  // namespace palpate::io::testing
