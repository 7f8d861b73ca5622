#include "io/fresh_folder.h"

#include <gtest/gtest.h>

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

TEST(FreshFolder, OnlyItsOwnerReadsATemporaryOne) {
  const FreshFolder temporary = temporary_folder();
  EXPECT_EQ(fs::status(temporary.path()).permissions(), fs::perms::owner_all);
}

TEST(FreshFolder, AllReadOneThatIsCommitted) {
  const FreshFolder temporary = temporary_folder();
  const fs::path place = temporary.path() / "out";
  FreshFolder folder(place);
  folder.commit();
  EXPECT_NE(fs::status(place).permissions() & fs::perms::others_read, fs::perms::none);
}

}  // namespace
}  // namespace palpate::io
