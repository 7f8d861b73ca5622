// Packed studies: read like their files, and with limits.
#include "io/unpack.h"

#include <archive.h>
#include <archive_entry.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>

#include "io/errors.h"
#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using Entries = std::vector<std::pair<std::string, std::string>>;  ///< names and bytes

/// By the name's ending: .zip, .tar.gz, or .gz of the one entry's bytes.
void pack(const fs::path& to, const Entries& entries, const char* password = nullptr) {
  archive* const writer = archive_write_new();
  const std::string name = to.filename().string();
  if (name.ends_with(".zip")) {
    archive_write_set_format_zip(writer);
    if (password != nullptr) {
      archive_write_set_options(writer, "zip:encryption=aes256");
      archive_write_set_passphrase(writer, password);
    }
  } else {
    name.ends_with(".tar.gz") ? archive_write_set_format_pax_restricted(writer) : archive_write_set_format_raw(writer);
    archive_write_add_filter_gzip(writer);
  }
  ASSERT_EQ(archive_write_open_filename(writer, to.c_str()), ARCHIVE_OK);
  for (const auto& [path, bytes] : entries) {
    archive_entry* const entry = archive_entry_new();
    archive_entry_set_pathname(entry, path.c_str());
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    archive_entry_set_size(entry, static_cast<la_int64_t>(bytes.size()));
    EXPECT_EQ(archive_write_header(writer, entry), ARCHIVE_OK) << archive_error_string(writer);
    archive_write_data(writer, bytes.data(), bytes.size());
    archive_entry_free(entry);
  }
  archive_write_close(writer);
  archive_write_free(writer);
}

/// A study of five slices, as files of an archive under these names.
Entries study(const std::string& folder) {
  const TestFolder made;
  write_stack(made.path(), 5);
  Entries entries;
  for (int k = 0; k < 5; ++k) {
    const std::string name = "s" + std::to_string(k) + ".dcm";
    entries.emplace_back(folder + name, bytes_of(made / name));
  }
  return entries;
}

/// Where archives are unpacked: a folder of this test, since others unpack at the same time.
class OwnTemporary {
 public:
  OwnTemporary() { setenv("TMPDIR", folder_.path().c_str(), 1); }
  OwnTemporary(const OwnTemporary&) = delete;
  OwnTemporary& operator=(const OwnTemporary&) = delete;
  ~OwnTemporary() { before_ ? setenv("TMPDIR", before_->c_str(), 1) : unsetenv("TMPDIR"); }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_.path()), {}); }

 private:
  const TestFolder folder_;
  const std::optional<std::string> before_ = [] {
    const char* const name = std::getenv("TMPDIR");
    return name != nullptr ? std::optional<std::string>(name) : std::nullopt;
  }();
};

void expect_the_study(const Catalogue& found) {
  ASSERT_THAT(found.series, SizeIs(1)) << (found.skipped.empty() ? Text() : found.skipped.front().reason);
  EXPECT_TRUE(found.series[0].usable);
  const Volume volume = load(found.series[0]);
  EXPECT_EQ(volume.geometry.dimensions.z, 5);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(volume.value_at(3, 2, k), 100 * k + 32);
}

TEST(Packed, StudiesAreReadNamedOrInTheirFolder) {
  for (const char* const name : {"study.zip", "study.tar.gz"}) {
    const TestFolder folder;
    Entries entries = study("CT/");
    entries.emplace_back("README.txt", "How to look at these images");
    pack(folder / name, entries);
    expect_the_study(find_series(std::array{folder / name}));
    const Catalogue found = find_series(std::array{folder.path()});
    expect_the_study(found);
    EXPECT_THAT(found.skipped, IsEmpty());
    EXPECT_EQ(found.series[0].files.front(), folder / name / "CT/s0.dcm");
  }
}

TEST(Packed, SingleFilesAreGunzipped) {
  const TestFolder folder;
  for (const auto& [name, bytes] : study("")) pack(folder / (name + ".gz"), {{name, bytes}});
  const Catalogue found = find_series(std::array{folder.path()});
  expect_the_study(found);
  EXPECT_EQ(found.series[0].files.front(), folder / "s0.dcm.gz" / "s0.dcm");
}

// What was unpacked stays while a series of it does, and not longer.
TEST(Packed, NothingIsLeftBehind) {
  const TestFolder folder;
  pack(folder / "study.zip", study(""));
  const OwnTemporary temporary;
  {
    const Series series = find_series(std::array{folder.path()}).series.at(0);
    EXPECT_EQ(temporary.entries(), 1);
    EXPECT_EQ(load(series).geometry.dimensions.z, 5);
  }
  EXPECT_EQ(temporary.entries(), 0);
}

TEST(Packed, NamesInAnArchiveAreNoPathsOnTheDisk) {
  const TestFolder folder;
  fs::create_directories(folder / "in");
  Entries entries = study("../../");
  entries.emplace_back((folder / "absolute.dcm").string(), study("").front().second);
  pack(folder / "in" / "study.tar.gz", entries);
  const auto unpacked = unpack(folder / "in" / "study.tar.gz", {});
  ASSERT_THAT(unpacked->files, SizeIs(6));
  for (const auto& file : unpacked->files) EXPECT_EQ(file.stored_at.parent_path(), unpacked->folder());
  EXPECT_FALSE(fs::exists(folder / "absolute.dcm"));
  EXPECT_FALSE(fs::exists(folder / "s0.dcm"));
  EXPECT_EQ(fs::status(unpacked->folder()).permissions() & (fs::perms::group_all | fs::perms::others_all),
            fs::perms::none);
}

std::string refusal_of(const fs::path& file) {
  const Catalogue found = find_series(std::array{file});
  EXPECT_THAT(found.series, IsEmpty());
  if (found.skipped.size() != 1) return "not refused";
  EXPECT_EQ(found.skipped[0].kind, "packed file");
  return found.skipped[0].reason;
}

// 300 MiB of zeros come out of 300 KB.
TEST(Packed, ABombIsRefusedEarly) {
  const TestFolder folder;
  const OwnTemporary temporary;
  pack(folder / "bomb.zip", {{"a.dcm", std::string(300U << 20, '\0')}});
  const std::clock_t begin = std::clock();
  EXPECT_EQ(refusal_of(folder / "bomb.zip"), "an archive that would unpack to more than 256 MiB: unpack it yourself");
  EXPECT_LT(std::clock() - begin, 5 * CLOCKS_PER_SEC);
  EXPECT_EQ(temporary.entries(), 0);
}

/// A header of a tar file (POSIX.1-1988) whose one entry is said to have so many bytes, in binary as GNU tar writes
/// sizes beyond 8 GiB.
std::string tar_header(std::uint64_t bytes) {
  std::string header(512, '\0');
  const auto put = [&](std::size_t at, const std::string& text) { header.replace(at, text.size(), text); };
  put(0, "a.dcm");
  put(100, "0000644");
  put(124, "\x80");
  for (std::size_t n = 0; n < 8; ++n) header[135 - n] = static_cast<char>(bytes >> (8 * n) & 0xFFU);
  put(148, "        ");
  put(156, "0");
  put(257, std::string("ustar\0", 6) + "00");
  unsigned sum = 0;
  for (const char c : header) sum += static_cast<unsigned char>(c);
  std::array<char, 16> octal{};
  std::snprintf(octal.data(), octal.size(), "%06o", sum);
  put(148, std::string(octal.data(), 7));
  return header;
}

// Of a large archive, half of what the disk has free, and 64 GiB at most.
TEST(Packed, ComesOutToNoMoreThanHalfOfTheDisksRoom) {
  const TestFolder folder;
  write_bytes(folder / "large.tar", tar_header(std::uint64_t{1} << 40U));
  fs::resize_file(folder / "large.tar", std::uintmax_t{2} << 30U);  // a hole
  const auto allowed_mib = [] {
    return std::min(static_cast<double>(fs::space(fs::temp_directory_path()).available) / 2, 64.0 * (1U << 30U)) /
           (1U << 20U);
  };
  const double before = allowed_mib();
  const std::string said = refusal_of(folder / "large.tar");
  const double after = allowed_mib();
  unsigned long mib = 0;
  ASSERT_EQ(std::sscanf(said.c_str(), "an archive that would unpack to more than %lu MiB", &mib), 1) << said;
  constexpr double others_write_mib = 1024;  // meanwhile
  EXPECT_GE(static_cast<double>(mib), std::min(before, after) - others_write_mib);
  EXPECT_LE(static_cast<double>(mib), std::max(before, after) + others_write_mib);
}

TEST(Packed, IsRefusedInWords) {
  const TestFolder folder;
  pack(folder / "text.zip", {{"a.txt", "no image"}});
  EXPECT_EQ(refusal_of(folder / "text.zip"), "an archive without a scan in it");
  pack(folder / "cut.tar.gz", study(""));
  fs::resize_file(folder / "cut.tar.gz", fs::file_size(folder / "cut.tar.gz") / 2);
  EXPECT_THAT(refusal_of(folder / "cut.tar.gz"), ::testing::StartsWith("an archive that cannot be unpacked ("));
  pack(folder / "locked.zip", study(""), "a password");
  EXPECT_THAT(refusal_of(folder / "locked.zip"), ::testing::StartsWith("an archive that cannot be unpacked ("));
}

TEST(Packed, IsCancelled) {
  const TestFolder folder;
  pack(folder / "large.zip", {{"a.dcm", std::string(100U << 20, '\0')}});
  EXPECT_THROW(unpack(folder / "large.zip", [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace palpate::io::internal
