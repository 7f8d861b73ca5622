#include "io/fresh_folder.h"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>

#include "io/testing/working_folder.h"

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

std::size_t entries_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
}

// Under another name beside its place until it is committed, and gone where it is not.
TEST(FreshFolder, IsThereWholeOrNotAtAll) {
  const FreshFolder scratch = temporary_folder();
  for (const char* const name : {"out", "deep/er/out", "ends/"}) {
    const fs::path place = scratch.path() / name;
    const fs::path parent = (place.has_filename() ? place : place.parent_path()).parent_path();
    {
      const FreshFolder folder(place);
      EXPECT_EQ(fs::canonical(folder.path()).parent_path(), fs::canonical(parent));
      std::ofstream(folder.path() / "part") << "part";
      EXPECT_FALSE(fs::exists(place));
    }
    EXPECT_EQ(entries_in(parent), 0U) << "nothing is left";
    {
      FreshFolder folder(place);
      std::ofstream(folder.path() / "whole") << "whole";
      folder.commit();
    }
    EXPECT_TRUE(fs::exists(place / "whole")) << name;
    EXPECT_EQ(entries_in(parent), 1U);
    EXPECT_THROW(FreshFolder again(place), std::runtime_error) << "there is something in it";
    fs::remove_all(scratch.path() / std::string(name).substr(0, std::string(name).find('/')));
  }
}

// A path is from the working folder on, with or without a folder before its name.
TEST(FreshFolder, OfAPathThatIsNotAbsoluteIsInTheWorkingFolder) {
  for (const char* const name : {"out", "out/", "./out", "deep/er/out", "../beside"}) {
    for (const bool at_once : {false, true}) {
      const FreshFolder scratch = temporary_folder();
      const fs::path from = scratch.path() / "from";
      fs::create_directory(from);
      const testing::WorkingFolder here(from);
      const auto write = [](const fs::path& place) { std::ofstream(place / "whole") << "whole"; };
      if (at_once) {
        write_all_or_none(name, write);
      } else {
        FreshFolder folder{fs::path(name)};
        write(folder.path());
        EXPECT_FALSE(fs::exists(from / name)) << name;
        folder.commit();
      }
      EXPECT_TRUE(fs::exists(from / name / "whole")) << name;
    }
  }
}

TEST(FreshFolder, TakesTheNameOfAnEmptyFolderAndOfNoFile) {
  const FreshFolder scratch = temporary_folder();
  fs::create_directory(scratch.path() / "empty");
  FreshFolder folder(scratch.path() / "empty");
  folder.commit();
  EXPECT_TRUE(fs::is_directory(scratch.path() / "empty"));
  std::ofstream(scratch.path() / "file") << "";
  EXPECT_THROW(FreshFolder again(scratch.path() / "file"), std::runtime_error);
}

TEST(WriteAllOrNone, LeavesNothingOfWhatFailed) {
  const FreshFolder scratch = temporary_folder();
  const fs::path place = scratch.path() / "out";
  EXPECT_THROW(write_all_or_none(place,
                                 [](const fs::path& folder) {
                                   std::ofstream(folder / "part") << "part";
                                   throw std::runtime_error("midway");
                                 }),
               std::runtime_error);
  EXPECT_EQ(entries_in(scratch.path()), 0U);
  write_all_or_none(place, [](const fs::path& folder) { std::ofstream(folder / "whole") << "whole"; });
  EXPECT_TRUE(fs::exists(place / "whole"));
}

TEST(WriteAllOrNone, WritesNowhereWithoutAPlace) {
  int times = 0;
  write_all_or_none({}, [&](const fs::path& folder) {
    ++times;
    EXPECT_TRUE(folder.empty());
  });
  EXPECT_EQ(times, 1);
}

}  // namespace
}  // namespace palpate::io
