// DCMTK without its data dictionary: refused at the start, before attributes are read as unknown.
#include "io/dicom/dcmtk_start.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "io/errors.h"

namespace palpate::io::internal {
namespace {

/// In a program of its own, since the dictionary is loaded as a program begins.
TEST(DcmtkStartDeathTest, IsRefusedWithoutItsDictionary) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto start = [] {
    try {
      start_dcmtk();
    } catch (const DicomError& error) {
      std::fputs(error.what(), stderr);
      std::_Exit(3);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(start(), ::testing::ExitedWithCode(0), "");
  ::setenv("DCMDICTPATH", "/no/such/dictionary", 1);
  EXPECT_EXIT(start(), ::testing::ExitedWithCode(3), "dictionary");
  ::unsetenv("DCMDICTPATH");
}

}  // namespace
}  // namespace palpate::io::internal
