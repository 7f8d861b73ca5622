#pragma once

/// Shared by the tests against a real archive: Debian's Orthanc, filled with generated series by DCMTK's storescu.
/// Expected values are read from the source files and from the output of DCMTK's programs.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "io/archive/archive.h"
#include "io/archive/testing/made_series.h"
#include "io/archive/testing/orthanc.h"
#include "io/fresh_folder.h"

namespace palpate::io::testing {

struct Instance {
  std::string study, series, pixels;
  std::string syntax;
};

/// All images in a folder, by SOP instance UID, read with DCMTK alone.
std::map<std::string, Instance> instances(const std::filesystem::path& folder);

/// The message of the ArchiveError that `act` throws; "no refusal" if it throws none.
std::string refusal(const std::function<void()>& act);

/// Two archives with the same content, one of them with TLS; started by the first test that needs them. The tests of
/// this suite are in several files.
class OrthancTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;

  static const Archive& archive() { return plain_->archive(); }
  static std::filesystem::path folder(const std::string& name) { return scratch_->path() / name; }
  static std::string uid_of(const std::string& series) {
    return instances(made_series() / series).begin()->second.series;
  }
  /// Checks that the fetched series is the given one, image by image and pixel by pixel.
  static void expect_same(const std::string& series, const std::filesystem::path& fetched);

  static inline std::unique_ptr<FreshFolder> scratch_;
  static inline std::unique_ptr<Orthanc> plain_, secure_;

 private:
  static void fill(const std::string& series);
};

}  // namespace palpate::io::testing
