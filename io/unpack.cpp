#include "io/unpack.h"

#include <archive.h>
#include <archive_entry.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

namespace fs = std::filesystem;
using Reader = std::unique_ptr<archive, int (*)(archive*)>;

std::string why(archive* reader) {
  const char* const said = archive_error_string(reader);
  return said != nullptr ? said : "no reason given";
}

Reader opened(const fs::path& path) {
  constexpr std::size_t block = 1U << 16;
  Reader reader(archive_read_new(), archive_read_free);
  for (const auto support :
       {archive_read_support_filter_gzip, archive_read_support_filter_bzip2, archive_read_support_filter_xz,
        archive_read_support_format_tar, archive_read_support_format_zip, archive_read_support_format_raw}) {
    support(reader.get());
  }
  if (archive_read_open_filename(reader.get(), path.c_str(), block) != ARCHIVE_OK) {
    throw DicomError(say("archive-cannot-be-unpacked", why(reader.get())));
  }
  return reader;
}

/// How much may come out.
class Limit {
 public:
  Limit(const fs::path& archive, const fs::path& folder) {
    constexpr std::uintmax_t any = std::uintmax_t{1} << 28, most = std::uintmax_t{1} << 36;
    constexpr std::uintmax_t most_times = 50;
    std::error_code unknown;
    const std::uintmax_t packed = fs::file_size(archive, unknown);
    const fs::space_info room = fs::space(folder, unknown);
    most_ = std::min(most, std::max(any, unknown ? 0 : most_times * std::min(packed, most)));
    if (!unknown) most_ = std::min(most_, room.available / 2);
    left_ = most_;
  }
  /// Refuses an entry by its stated size before it is unpacked; the unpacked size counts.
  void check(std::uintmax_t bytes) const {
    if (bytes > left_) throw DicomError(say("archive-holds-too-much", most_ >> 20U));
  }
  void take(std::uintmax_t bytes) {
    check(bytes);
    left_ -= bytes;
  }

 private:
  std::uintmax_t most_ = 0;
  std::uintmax_t left_ = 0;
};

void write_entry(archive* reader, const fs::path& to, Limit& limit, const Progress& progress) {
  std::ofstream file(to, std::ios::binary);
  std::array<char, 1U << 16> bytes{};
  for (std::size_t blocks = 1;; ++blocks) {
    const la_ssize_t got = archive_read_data(reader, bytes.data(), bytes.size());
    if (got < 0) throw DicomError(say("archive-cannot-be-unpacked", why(reader)));
    if (got == 0) break;
    limit.take(static_cast<std::uintmax_t>(got));
    file.write(bytes.data(), got);
    constexpr std::size_t often = 64;
    if (blocks % often == 0 && progress && !progress(0)) throw Cancelled();
  }
  file.close();
  if (!file) throw DicomError(say("archive-does-not-fit-on-the-disk", to.parent_path().string()));
}

// The name shown to the user; it is not used to open files. A gzipped file without a name gets its archive's, without
// the ending.
fs::path shown_as(const fs::path& archive, archive_entry* entry, bool is_raw) {
  if (is_raw) return archive.stem();
  const char* const name = archive_entry_pathname(entry);
  return fs::path(name != nullptr ? name : "").relative_path().lexically_normal();
}

}  // namespace

Unpacked::Unpacked() {
  std::error_code error;
  std::string name = (fs::temp_directory_path(error) / "palpate-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw DicomError(say("archive-does-not-fit-on-the-disk", fs::path(name).parent_path().string()));
  }
  folder_ = name;
}

Unpacked::~Unpacked() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

bool is_archive(const fs::path& file) {
  std::array<char, 262> bytes{};
  std::ifstream(file, std::ios::binary).read(bytes.data(), bytes.size());
  constexpr std::array<std::string_view, 4> beginnings{"PK\3\4", "\x1f\x8b", "BZh",
                                                       "\xfd"
                                                       "7zXZ"};
  const std::string_view start(bytes.data(), bytes.size());
  constexpr std::size_t of_tar = 257;  // POSIX.1-1988
  return start.substr(of_tar).starts_with("ustar") ||
         std::ranges::any_of(beginnings, [&](std::string_view one) { return start.starts_with(one); });
}

std::shared_ptr<const Unpacked> unpack(const fs::path& archive, const Progress& progress) {
  constexpr std::size_t most_files = 1'000'000;
  const Reader reader = opened(archive);
  auto unpacked = std::make_shared<Unpacked>();
  Limit limit(archive, unpacked->folder());
  for (archive_entry* entry = nullptr;;) {
    const int status = archive_read_next_header(reader.get(), &entry);
    if (status == ARCHIVE_EOF) break;
    if (status < ARCHIVE_WARN) throw DicomError(say("archive-cannot-be-unpacked", why(reader.get())));
    const bool is_raw = archive_format(reader.get()) == ARCHIVE_FORMAT_RAW;
    const auto type = archive_entry_filetype(entry);
    if (!is_raw && type != AE_IFREG && type != 0) continue;  // a zip that is streamed may not say it
    if (unpacked->files.size() >= most_files) throw DicomError(say("archive-holds-too-many-files", most_files));
    if (archive_entry_size_is_set(entry) != 0) {
      limit.check(static_cast<std::uintmax_t>(std::max<la_int64_t>(0, archive_entry_size(entry))));
    }
    const fs::path to = unpacked->folder() / std::to_string(unpacked->files.size());
    write_entry(reader.get(), to, limit, progress);
    unpacked->files.push_back({shown_as(archive, entry, is_raw), to});
  }
  return unpacked;
}

}  // namespace palpate::io::internal
