// Files that are damaged, truncated or malicious: the reader refuses them quickly, and allocates no more than their
// bytes justify.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <chrono>
#include <fstream>
#include <random>

#include "io/errors.h"
#include "io/load.h"
#include "io/testing/file_bytes.h"
#include "io/testing/test_coders.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::SizeIs;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool under_sanitizer = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
constexpr bool under_sanitizer = true;
#else
constexpr bool under_sanitizer = false;
#endif
#else
constexpr bool under_sanitizer = false;
#endif

/// The most memory this process has held; always 0 under a sanitizer, whose own bookkeeping outweighs the reader's.
long peak_mib() {
  if (under_sanitizer) return 0;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

/// The most since it was last reset (VmHWM).
long peak_now_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stol(line.substr(6)) / 1024;
  }
  return 0;
}

/// Preamble and meta information of an explicit little-endian file.
std::string part_10_start() {
  const TestFolder folder;
  write(TestImage(), folder / "f");
  const std::string bytes = bytes_of(folder / "f");
  return bytes.substr(0, bytes.find(std::string("\x08\x00\x08\x00", 4)));
}

std::string only_reason(const TestFolder& folder) {
  const Catalogue found = find_series(std::array{folder.path()});
  EXPECT_THAT(found.skipped, SizeIs(1));
  return found.skipped.empty() ? Text() : found.skipped[0].reason;
}

constexpr std::array codings{EXS_RLELossless, EXS_JPEGProcess14SV1, EXS_JPEGLSLossless, EXS_JPEG2000LosslessOnly};

/// Three slices of 32 x 32, s0.dcm to s2.dcm, compressed.
void write_coded(const fs::path& folder, E_TransferSyntax syntax) {
  register_encoders();
  write_stack(folder, 3, [syntax](int, TestImage& image) {
    image.columns = image.rows = 32;
    image.value = [](int i, int j) { return 13 * i + 7 * j; };
    image.syntax = syntax;
    image.edit = [syntax, &image](DcmDataset& d) {
      const auto coded = syntax == EXS_JPEGLSLossless         ? jpeg_ls(32, 32, 16, 0, image.value)
                         : syntax == EXS_JPEG2000LosslessOnly ? jpeg2000(32, 32, 16, false, image.value)
                                                              : std::vector<Uint8>();
      if (!coded.empty()) encapsulate(d, syntax, {coded}, 1U << 20);
    };
  });
}

TEST(Hostile, ClaimedSizesCostNoMemory) {
  const long before = peak_mib();
  for (const bool many_frames : {false, true}) {
    const auto claim = [&](DcmDataset& d) {
      if (many_frames) {
        make_multi_frame(d, {1, 2, 3});
        put(d, DCM_NumberOfFrames, "100000000");
      }
      put(d, DCM_Rows, 60000);
      put(d, DCM_Columns, 60000);
    };
    for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
      const TestFolder folder;
      TestImage image;
      image.edit = claim;
      image.syntax = syntax;
      write(image, folder / "claims");
      for (const Series& series : find_series(std::array{folder.path()}).series) EXPECT_FALSE(series.usable);
    }
  }
  for (const E_TransferSyntax syntax : codings) {
    const TestFolder folder;
    write_coded(folder.path(), syntax);
    ASSERT_TRUE(find_series(std::array{folder.path()}).series.at(0).usable);
    for (int k = 0; k < 3; ++k) {
      const fs::path file = folder / (numbered("s", k) + ".dcm");
      std::string bytes = bytes_of(file);
      for (const char* attribute : {"\x28\x00\x10\x00US", "\x28\x00\x11\x00US"}) {
        bytes.replace(bytes.find(std::string(attribute, 6)) + 8, 2, "\x60\xEA");
      }
      write_bytes(file, bytes);
    }
    for (const Series& series : find_series(std::array{folder.path()}).series) EXPECT_FALSE(series.usable);
  }
  EXPECT_LT(peak_mib() - before, 64);
}

/// Runs in a child of its own, since the most memory a process has held never shrinks: MiB above what it started with.
long mib_to_load(const fs::path& folder) {
  int report[2];
  if (::pipe(report) != 0) throw std::runtime_error("no pipe");
  const pid_t child = ::fork();
  if (child == 0) {
    long used = -1;
    try {
      const std::array start{fs::path("/dev/null")};
      static_cast<void>(find_series(start));        // DCMTK's dictionary is not the scan's
      std::ofstream("/proc/self/clear_refs") << 5;  // the peak starts anew
      const long before = peak_now_mib();
      static_cast<void>(load(find_series(std::array{folder}).series.at(0)));
      used = peak_now_mib() - before;
    } catch (const std::exception&) {
    }
    const ssize_t written = ::write(report[1], &used, sizeof used);
    ::_exit(written == sizeof used ? 0 : 1);
  }
  long used = -1;
  ::close(report[1]);
  const ssize_t got = ::read(report[0], &used, sizeof used);
  ::close(report[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  return got == sizeof used ? used : -1;
}

/// Large enough that holding it twice is told from noise: 105 MiB.
TEST(Hostile, LoadingAGeneratedSeriesHoldsLittleMoreThanTheVolume) {
  if (under_sanitizer)
    GTEST_SKIP() << "a sanitizer's own bookkeeping outweighs the reader's memory; measured without one";
  const TestFolder folder;
  write_stack(folder.path(), 168, [](int k, TestImage& image) {
    image.columns = 640;
    image.rows = 512;
    image.value = [k](int i, int j) { return k + i + j; };
  });
  const double stored_mib = 2.0 * 640 * 512 * 168 / (1 << 20);
  const long used = mib_to_load(folder.path());
  EXPECT_GE(used, static_cast<long>(stored_mib) - 1);
  EXPECT_LT(static_cast<double>(used), 1.25 * stored_mib + 64);
}

TEST(SharedHostile, LoadingHoldsLittleMoreThanTheVolume) {
  const fs::path data = PALPATE_SHARED_DATA;
  if (!fs::exists(data))
    GTEST_SKIP() << "needs the shared series, whose size tells peak memory from noise: not at " << data;
  if (under_sanitizer)
    GTEST_SKIP() << "a sanitizer's own bookkeeping outweighs the reader's memory; measured without one";
  for (const char* name : {"ct_head_phantom_140", "mr_t1_ax_384", "mr_enh_philips_fieldmap_64f"}) {
    const Series series = find_series(std::array{data / name}).series.at(0);
    const glm::ivec3 size = series.geometry.dimensions;
    const double stored_mib = 2.0 * size.x * size.y * size.z / (1 << 20);
    const long used = mib_to_load(data / name);
    ASSERT_GE(used, static_cast<long>(stored_mib) - 1) << name;
    EXPECT_LT(static_cast<double>(used), 1.25 * stored_mib + 64) << name;
    RecordProperty(name, std::to_string(used) + " MiB for " + std::to_string(stored_mib));
  }
}

TEST(Hostile, SequencesNestedWithoutEndAreRefused) {
  const TestFolder folder;
  std::string bytes = part_10_start();
  for (int n = 0; n < 100000; ++n) {
    bytes += std::string("\x08\x00\x40\x11SQ\0\0\xFF\xFF\xFF\xFF\xFE\xFF\x00\xE0\xFF\xFF\xFF\xFF", 20);
  }
  write_bytes(folder / "deep", bytes);
  EXPECT_THAT(only_reason(folder), HasSubstr("nested too deeply"));
}

TEST(Hostile, ElementsInNoOrderAreRefused) {
  const TestFolder folder;
  std::string bytes = part_10_start();
  for (int n = 0xFFFF; n > 0x2000; --n) {
    bytes += std::string("\x09\x00", 2) + static_cast<char>(n & 0xFF) + static_cast<char>(n >> 8) + "LO" +
             std::string(
                 "\x02\x00"
                 "ab",
                 4);
  }
  write_bytes(folder / "descending", bytes);
  EXPECT_THAT(only_reason(folder), HasSubstr("in disorder"));
}

// Cut anywhere, a file is named with a reason, or was not cut where it matters.
TEST(Hostile, FileCutAnywhere) {
  const TestFolder folder;
  write_stack(folder.path(), 3);
  const std::string whole = bytes_of(folder / "s1.dcm");
  for (std::size_t length = 0; length < whole.size(); length += 3) {
    write_bytes(folder / "s1.dcm", whole.substr(0, length));
    const Catalogue found = find_series(std::array{folder.path()});
    ASSERT_THAT(found.skipped, SizeIs(1)) << length;
    EXPECT_THAT(found.skipped[0].reason, AnyOf(HasSubstr("truncated"), HasSubstr("not a DICOM"), HasSubstr("empty"),
                                               HasSubstr("no image"), HasSubstr("no pixels"), HasSubstr("damaged")))
        << length;
    ASSERT_THAT(found.series, SizeIs(1)) << length;
    EXPECT_EQ(load(found.series[0]).geometry.dimensions.z, 2) << length;
  }
}

// Seeded mutations of one slice of every coding: the others are still read, nothing crashes, hangs or grows.
TEST(Hostile, RandomDamageCostsAtMostThatSlice) {
  const fs::path data = PALPATE_SHARED_DATA;
  std::vector<fs::path> seeds;
  for (const char* name : {"mr_tx_jpeg_4", "mr_tx_rle_4", "mr_tx_j2k_4", "mr_enh_philips_fieldmap_64f"}) {
    std::error_code absent;
    for (const auto& entry : fs::directory_iterator(data / name, absent)) seeds.push_back(entry.path());
  }
  const TestFolder plain;
  write(TestImage(), plain / "plain");
  seeds.push_back(plain / "plain");
  std::array<TestFolder, codings.size()> coded;
  for (std::size_t n = 0; n < codings.size(); ++n) {
    write_coded(coded[n].path(), codings[n]);
    seeds.push_back(coded[n] / "s1.dcm");
  }
  const long before = peak_mib();
  std::mt19937 random(20240229);
  for (const fs::path& seed : seeds) {
    const std::string good = bytes_of(seed);
    for (int n = 0; n < 24; ++n) {
      const TestFolder folder;
      std::string bad = good;
      const std::size_t changes = 1 + random() % 8;
      for (std::size_t c = 0; c < changes; ++c) {
        // Half of the damage goes to the header, where it does most.
        const std::size_t range = random() % 2 == 0 ? std::min<std::size_t>(2000, bad.size() - 132) : bad.size() - 132;
        bad[132 + random() % range] = static_cast<char>(random());
      }
      write_bytes(folder / "bad", bad);
      write_stack(folder.path(), 3);
      const Catalogue found = find_series(std::array{folder.path()});
      const auto ours =
          std::find_if(found.series.begin(), found.series.end(), [](const Series& s) { return s.uid == "1.2.3.4"; });
      ASSERT_NE(ours, found.series.end());
      EXPECT_GE(load(*ours).geometry.dimensions.z, 3);
      for (const Series& series : found.series) {
        try {
          static_cast<void>(statistics(load(series)));
        } catch (const DicomError&) {  // named, as it should be
        }
      }
    }
  }
  EXPECT_LT(peak_mib() - before, 256);
}

/// Deflates (RFC 1951) as it goes, so that what is inflated need not be held.
class Deflater {
 public:
  Deflater() {
    if (deflateInit2(&stream_, 6, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;
  ~Deflater() { deflateEnd(&stream_); }
  void add(std::string bytes, int flush = Z_NO_FLUSH) {
    stream_.next_in = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_in = static_cast<uInt>(bytes.size());
    do {
      std::array<char, 1U << 16> out{};
      stream_.next_out = reinterpret_cast<Bytef*>(out.data());
      stream_.avail_out = out.size();
      deflate(&stream_, flush);
      deflated.append(out.data(), out.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }
  std::string deflated;

 private:
  z_stream stream_{};
};

/// A deflated image that has a private element of so many zeros in front of all that places it.
void write_deflated(const fs::path& path, int mib_of_zeros) {
  TestImage image;
  image.value = [](int i, int j) { return 10 * j + i; };
  write(image, path);
  std::string plain = bytes_of(path);
  const std::size_t at = plain.find(std::string("\x08\x00\x08\x00", 4));
  std::string meta = plain.substr(0, at);
  const std::size_t syntax = meta.find("1.2.840.10008.1.2.1");
  meta.replace(syntax, 20, std::string("1.2.840.10008.1.2.1.99"));  // longer by two
  const std::size_t length = syntax - 2;
  meta[length] = static_cast<char>(meta[length] + 2);
  const std::size_t group = meta.find(std::string("\x02\x00\x00\x00UL\x04\x00", 8)) + 8;
  meta[group] = static_cast<char>(meta[group] + 2);
  const std::string dataset = plain.substr(at);
  const std::size_t patient = dataset.find(std::string("\x18\x00\x50\x00", 4));
  Deflater deflater;
  deflater.add(dataset.substr(0, patient));
  const std::uint32_t size = static_cast<std::uint32_t>(mib_of_zeros) << 20;
  std::string element("\x11\x00\x01\x10OB\0\0", 8);
  for (int n = 0; n < 4; ++n) element += static_cast<char>(size >> 8 * n);
  deflater.add(element);
  for (int n = 0; n < mib_of_zeros; ++n) deflater.add(std::string(1U << 20, '\0'));
  deflater.add(dataset.substr(patient), Z_FINISH);
  write_bytes(path, meta + deflater.deflated);
}

// What a few megabytes may grow to is bounded as what lies there in full would be.
TEST(Hostile, DeflatedHeaderCountsByWhatComesOut) {
  const TestFolder folder;
  write_deflated(folder / "bomb", 1000);
  EXPECT_LT(fs::file_size(folder / "bomb"), 2U << 20);
  const long before = peak_mib();
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(only_reason(folder), "its header is larger than 256 MiB");
  EXPECT_LT(peak_mib() - before, 64);
  if (!under_sanitizer) {
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  }
}

// What nobody asks for costs no memory there, either.
TEST(Hostile, DeflatedPrivateElementCostsNoMemory) {
  const TestFolder folder;
  write_deflated(folder / "heavy", 200);
  const long before = peak_mib();
  const Catalogue found = find_series(std::array{folder.path()});
  EXPECT_LT(peak_mib() - before, 64);
  ASSERT_THAT(found.series, SizeIs(1));
  EXPECT_EQ(load(found.series[0]).value_at(5, 3, 0), 35);
}

}  // namespace
}  // namespace palpate::io::internal
