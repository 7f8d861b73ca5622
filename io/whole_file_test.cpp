#include "io/whole_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

#include "io/archive/testing/says.h"
#include "io/errors.h"
#include "io/fresh_folder.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using testing::says;

std::string text_of_file(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string refusal_of(const fs::path& file, const std::string& bytes, Existing existing) {
  try {
    write_whole(file, bytes, existing);
  } catch (const DicomError& error) {
    return error.what();
  }
  return "no refusal";
}

int files_in(const fs::path& folder) {
  return static_cast<int>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(WholeFile, IsWritten) {
  const FreshFolder scratch = temporary_folder();
  const fs::path file = scratch.path() / "Müller.dcm";
  for (const std::string& bytes : {std::string("a\0b", 3), std::string(), std::string(1'000'000, 'x')}) {
    write_whole(file, bytes, Existing::replace);
    EXPECT_EQ(text_of_file(file), bytes);
    EXPECT_EQ(files_in(scratch.path()), 1);
  }
}

TEST(WholeFile, IsKeptUnlessItMayBeReplaced) {
  const FreshFolder scratch = temporary_folder();
  const fs::path file = scratch.path() / "kept", link = scratch.path() / "link";
  std::ofstream(file) << "kept";
  fs::create_symlink("nowhere", link);
  for (const fs::path& there : {file, link, scratch.path()}) {
    EXPECT_TRUE(says(refusal_of(there, "other", Existing::keep),
                     "{} exists: name another file, or ask for it to be overwritten"));
  }
  EXPECT_EQ(text_of_file(file), "kept");
  EXPECT_TRUE(says(refusal_of(scratch.path(), "other", Existing::replace),
                   "{} cannot be written: make room, or name another folder"));
  EXPECT_EQ(files_in(scratch.path()), 2);
}

/// What a full disk does, this limit does for one process: some bytes are written, the next are not.
TEST(WholeFile, IsNotThereWhereOnlyAPartCouldBeWritten) {
  const FreshFolder scratch = temporary_folder();
  const fs::path file = scratch.path() / "whole";
  write_whole(file, "before", Existing::keep);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  for (const std::size_t size : {std::size_t{100'001}, std::size_t{200'000}, std::size_t{50'000'000}}) {
    const rlimit full{100'000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
    const std::string said = refusal_of(file, std::string(size, 'x'), Existing::replace);
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    EXPECT_TRUE(says(said, "{} cannot be written: make room, or name another folder")) << said;
    EXPECT_EQ(text_of_file(file), "before");
    EXPECT_EQ(files_in(scratch.path()), 1);
  }
  EXPECT_TRUE(says(refusal_of("/no/such/folder/file", "x", Existing::keep),
                   "{} cannot be written: make room, or name another folder"));
}

}  // namespace
}  // namespace palpate::io
