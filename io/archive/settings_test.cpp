// Valid settings of an archive: at their limits, and character by character.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "io/archive/archive.h"
#include "io/archive/testing/says.h"

namespace palpate::io {
namespace {

Archive sound_archive() {
  return {.name = "a", .host = "h", .port = 104, .called = "CALLED", .calling = "US"};
}

bool may_be_set(const Archive& archive) {
  try {
    check(archive);
  } catch (const ArchiveError&) {
    return false;
  }
  return true;
}

/// The ports that PS3.8 and IANA name.
TEST(SettingsLimits, WhatIsNotSetIsAsDocumented) {
  const Archive archive;
  EXPECT_EQ(archive.port, 104);
  EXPECT_FALSE(archive.uses_get);
  EXPECT_EQ(archive.listen_address, "0.0.0.0");
  EXPECT_EQ(archive.listen_port, 11112);
  EXPECT_EQ(archive.silence_s, 30);
  EXPECT_FALSE(archive.tls.used);
}

TEST(SettingsLimits, NumbersAreWithinTheirEnds) {
  for (const auto& [port, fits] : {std::pair{-1, false}, {0, false}, {1, true}, {65535, true}, {65536, false}}) {
    for (int Archive::*const which : {&Archive::port, &Archive::listen_port}) {
      Archive archive = sound_archive();
      archive.*which = port;
      EXPECT_EQ(may_be_set(archive), fits) << port;
    }
  }
  for (const auto& [silence, fits] : {std::pair{-1, false}, {0, false}, {1, true}, {3600, true}, {3601, false}}) {
    Archive archive = sound_archive();
    archive.silence_s = silence;
    EXPECT_EQ(may_be_set(archive), fits) << silence;
  }
}

// PS3.5 6.2, AE: 16 characters of the default repertoire but for the backslash and what controls; not of spaces alone.
TEST(SettingsLimits, TitlesAreOfPrintableCharacters) {
  for (std::string Archive::*const which : {&Archive::called, &Archive::calling}) {
    Archive archive = sound_archive();
    for (int c = 1; c < 256; ++c) {
      archive.*which = std::string("A") + static_cast<char>(c) + "B";
      EXPECT_EQ(may_be_set(archive), c >= 32 && c <= 126 && c != '\\') << c;
    }
    for (const std::string& good : {std::string(16, 'A'), std::string("A"), std::string(" A "), std::string("A B")}) {
      archive.*which = good;
      EXPECT_TRUE(may_be_set(archive)) << good;
    }
    for (const std::string& bad : {std::string(17, 'A'), std::string(), std::string(" "), std::string(16, ' ')}) {
      archive.*which = bad;
      EXPECT_FALSE(may_be_set(archive)) << bad;
    }
  }
}

TEST(SettingsLimits, AHostIsPrintableAndNotLong) {
  Archive archive = sound_archive();
  for (const std::string& good : {std::string("127.0.0.1"), std::string(64, 'a')}) {
    archive.host = good;
    EXPECT_TRUE(may_be_set(archive)) << good;
  }
  for (const std::string& bad : {std::string(), std::string("a\nb"), std::string(65, 'a')}) {
    archive.host = bad;
    EXPECT_FALSE(may_be_set(archive)) << bad;
  }
}

// With TLS: an authority always; a certificate and its key together, and not without them where images come by C-MOVE.
TEST(SettingsLimits, TlsNeedsWhatItUses) {
  for (int bits = 0; bits < 32; ++bits) {
    Archive archive = sound_archive();
    archive.tls.used = (bits & 1) != 0;
    if ((bits & 2) != 0) archive.tls.authorities = "ca.pem";
    if ((bits & 4) != 0) archive.tls.certificate = "own.pem";
    if ((bits & 8) != 0) archive.tls.key = "own.key";
    archive.uses_get = (bits & 16) != 0;
    const bool has_certificate = (bits & 4) != 0, has_key = (bits & 8) != 0;
    const bool fits =
        !archive.tls.used || ((bits & 2) != 0 && has_certificate == has_key && (archive.uses_get || has_certificate));
    EXPECT_EQ(may_be_set(archive), fits) << bits;
  }
}

TEST(ArchiveSettings, ThatCannotBeAreRefused) {
  const Archive archive{.name = "a", .host = "h", .port = 104, .called = "CALLED", .calling = "US"};
  EXPECT_NO_THROW(check(archive));
  const auto refused = [&](const char* message, auto change) {
    Archive wrong = archive;
    change(wrong);
    try {
      check(wrong);
      ADD_FAILURE() << "not refused: " << message;
    } catch (const ArchiveError& error) {
      EXPECT_TRUE(testing::says(error.what(), message));
      EXPECT_TRUE(std::string(error.what()).starts_with("archive a: ")) << error.what();
    }
  };
  refused("--host has to be a machine's name or address", [](Archive& a) { a.host = ""; });
  refused("a port is a number from 1 to 65535", [](Archive& a) { a.port = 65536; });
  refused("a port is a number from 1 to 65535", [](Archive& a) { a.listen_port = 0; });
  refused("an AE title has 1 to 16 letters, digits or signs", [](Archive& a) { a.called = "LONGER THAN SIXTEEN"; });
  refused("an AE title has 1 to 16 letters, digits or signs", [](Archive& a) { a.calling = "  "; });
  refused("an AE title has 1 to 16 letters, digits or signs", [](Archive& a) { a.calling = "A\\B"; });
  refused("the time to wait has to be 1 to 3600 s", [](Archive& a) { a.silence_s = 0; });
  refused("TLS needs --tls-ca, the certificate of the authority that signed the archive's certificate",
          [](Archive& a) { a.tls.used = true; });
  refused("C-MOVE with TLS needs --tls-certificate and --tls-key, since the archive then connects to us; or set --get",
          [](Archive& a) {
            a.tls = {true, "ca.pem", "", "", ""};
          });
  refused("--tls-certificate and --tls-key go together", [](Archive& a) {
    a.tls = {true, "ca.pem", "own.pem", "", ""};
  });
}

}  // namespace
}  // namespace palpate::io
