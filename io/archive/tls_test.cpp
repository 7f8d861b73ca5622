// TLS with a real archive, and with a program that only presents a certificate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/archive/fetch.h"
#include "io/archive/find.h"
#include "io/archive/send.h"
#include "io/archive/testing/orthanc_test_case.h"
#include "io/archive/testing/process.h"
#include "io/archive/testing/says.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::ct;
using ::testing::HasSubstr;
using testing::made_series;
using testing::OrthancTest;
using testing::refusal;
using testing::says;

TEST_F(OrthancTest, DoesAllOfItWithTls) {
  const fs::path certificates = folder("certificates");
  if (!testing::make_certificates(certificates)) GTEST_SKIP() << "openssl is not installed: apt-get install openssl";
  secure_ = std::make_unique<testing::Orthanc>(folder("secure"), certificates);
  const Archive& secure = secure_->archive();
  EXPECT_NO_THROW(echo(secure));
  Archive elsewhere = secure;
  elsewhere.tls.name = "other.example";
  EXPECT_THAT(refusal([&] { echo(elsewhere); }), HasSubstr("showed a certificate that is not for other.example"));
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(made_series() / ct)) files.push_back(entry.path());
  EXPECT_EQ(send(secure, files).files, files.size());
  EXPECT_EQ(find(secure, {}).studies.size(), 1U);
  fetch(secure, {uid_of(ct)}, folder("tls-move"));
  expect_same(ct, folder("tls-move"));
  Archive by_get = secure;
  by_get.uses_get = true;
  fetch(by_get, {uid_of(ct)}, folder("tls-get"));
  expect_same(ct, folder("tls-get"));

  Archive plain = secure;
  plain.tls = {};
  EXPECT_THAT(refusal([&] { echo(plain); }), HasSubstr("without TLS on that port"));
  Archive unknown = secure;
  unknown.tls.authorities = certificates / "palpate.pem";  // not who signed the archive's certificate
  EXPECT_TRUE(
      says(refusal([&] { echo(unknown); }),
           "TLS with {} failed: check --tls-ca, --tls-certificate and --tls-key, and that the port speaks TLS"));
  Archive unreadable = secure;
  unreadable.tls.key = certificates / "no-such.key";
  EXPECT_THAT(refusal([&] { echo(unreadable); }),
              HasSubstr("--tls-key " + unreadable.tls.key.string() + " cannot be used for TLS"));
  Archive mixed_up = secure;
  mixed_up.tls.key = certificates / "archive.key";
  EXPECT_TRUE(
      says(refusal([&] { echo(mixed_up); }), "archive {}: --tls-key {} does not belong to --tls-certificate {}"));
  secure_.reset();
}

// The peer is a program of OpenSSL's own that shows a certificate and speaks no DICOM: what it is asked for has to fail
// by the name before a word of DICOM is said.
TEST_F(OrthancTest, RefusesACertificateForAnotherMachine) {
  const fs::path certificates = folder("names");
  if (!testing::make_certificates(certificates)) GTEST_SKIP() << "openssl is not installed: apt-get install openssl";
  const int port = testing::free_port();
  const testing::Process server({"openssl", "s_server", "-quiet", "-accept", "127.0.0.1:" + std::to_string(port),
                                 "-cert", (certificates / "archive.pem").string(), "-key",
                                 (certificates / "archive.key").string()});
  for (int n = 0; n < 500 && !testing::is_listening(port); ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  Archive peer = archive();
  peer.port = port;
  peer.silence_s = 2;
  peer.uses_get = true;
  peer.tls = {true, certificates / "authority.pem", "", "", ""};
  const auto refused_by_name = [&](const std::string& host, const std::string& name) {
    peer.host = host;
    peer.tls.name = name;
    const std::string said = refusal([&] { echo(peer); });
    EXPECT_NE(said, "no refusal");
    return !!says(
        said,
        "{} showed a certificate that is not for {}: set --host to the name or address that it is for, or set "
        "--tls-name if you know that it is the archive's certificate");
  };
  EXPECT_FALSE(refused_by_name("127.0.0.1", ""));
  EXPECT_FALSE(refused_by_name("localhost", "pacs.example"));
  EXPECT_FALSE(refused_by_name("localhost", "127.0.0.1"));
  EXPECT_TRUE(refused_by_name("localhost", "")) << "it is for 127.0.0.1 and pacs.example alone";
  EXPECT_TRUE(refused_by_name("127.0.0.1", "127.0.0.2"));
  EXPECT_TRUE(refused_by_name("127.0.0.1", "example"));
  EXPECT_TRUE(refused_by_name("127.0.0.1", "evil.pacs.example"));
  EXPECT_TRUE(refused_by_name("127.0.0.1", "archive")) << "its common name counts only where it has no other names";
}

}  // namespace
}  // namespace palpate::io
