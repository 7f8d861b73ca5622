#include "io/archive/inbox.h"

#include <dcmtk/dcmdata/dcostrmf.h>
#include <dcmtk/dcmdata/dctk.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;

constexpr std::uint16_t not_what_was_asked = STATUS_STORE_Error_CannotUnderstand;

std::string reason(int number) {
  return std::generic_category().message(number);
}

[[noreturn]] void cannot_write(const fs::path& folder, const std::string& why) {
  throw ArchiveError(say("fetched-cannot-be-written", folder.string(), why));
}

/// A file that is gone again unless it is kept.
class PartFile {
 public:
  explicit PartFile(fs::path path) : path_(std::move(path)) {}
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  ~PartFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

}  // namespace

Inbox::Inbox(const fs::path& folder, const FetchLimits& limits) : folder_(folder), limits_(limits) {
  std::error_code error;
  made_folder_ = fs::create_directories(folder, error);
  if (error) cannot_write(folder, error.message());
  if (made_folder_) fs::permissions(folder, fs::perms::owner_all, error);
  std::string name = (folder / ".fetching-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    const int number = errno;
    if (made_folder_) fs::remove(folder, error);
    cannot_write(folder, reason(number));
  }
  staging_ = name;  // 0700, as mkdtemp() makes it
}

Inbox::~Inbox() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (made_folder_) fs::remove(folder_, ignored);  // only where it is empty
}

void Inbox::expect(const Wanted& wanted) {
  const std::lock_guard lock(mutex_);
  wanted_ = wanted;
  instances_of_wanted_.clear();
  came_.store(0, std::memory_order_relaxed);
}

bool Inbox::is_wanted(const Header& header) {
  return !header.series_uid.empty() && header.study_uid == wanted_.study_uid &&
         (wanted_.series_uid.empty() || header.series_uid == wanted_.series_uid);
}

void Inbox::keep(const fs::path& file, const Header& header) {
  Series& series = series_[header.series_uid];
  if (series.folder.empty()) {
    series.study_uid = header.study_uid;
    series.folder = staging_ / fmt::format("series-{:03}", series_.size());
    fs::create_directory(series.folder);
    fs::permissions(series.folder, fs::perms::owner_all);
  }
  fs::rename(file, series.folder / fmt::format("image-{:06}.dcm", ++series.files));
}

std::uint16_t Inbox::store(T_ASC_Association& association, Watch& watch, int silence_s, const Command& command,
                           const KeepGoing& keep_going, OFCondition& broken) {
  const std::lock_guard lock(mutex_);
  const T_DIMSE_C_StoreRQ& request = command.message.msg.CStoreRQ;
  if (files() >= limits_.files) {
    throw ArchiveError(say("more-than-files-came", limits_.files));
  }
  const PartFile part(staging_ / fmt::format("part-{:06}", ++number_));
  DcmOutputFileStream* opened = nullptr;
  errno = 0;
  const OFCondition made =
      DIMSE_createFilestream(part.path().c_str(), &request, &association, command.context, OFTrue, &opened);
  std::unique_ptr<DcmOutputFileStream> file(opened);
  if (made.bad()) cannot_write(folder_, reason(errno == 0 ? EIO : errno));
  bool cancelled = false, full = false, too_much = false;
  int error = 0;
  std::uint64_t size = 0;
  broken = stream_dataset(association, silence_s, watch, [&](const void* data, std::size_t n) {
    received_bytes_.fetch_add(n, std::memory_order_relaxed);
    errno = 0;
    cancelled = keep_going && !keep_going();
    too_much = bytes() + size + n > limits_.bytes;
    if (cancelled || too_much) return false;
    const offile_off_t written = file->write(data, static_cast<offile_off_t>(n));
    full = !file->good() || written != static_cast<offile_off_t>(n);
    error = errno;
    size += n;
    return !full;
  });
  errno = 0;
  const auto expected = static_cast<std::uint64_t>(file->tell());
  file.reset();  // what is in its buffer is written now
  if (cancelled) throw Cancelled();
  if (too_much) {
    throw ArchiveError(say("more-than-mib-came", limits_.bytes >> 20U));
  }
  if (!full && broken.good() && fs::file_size(part.path()) != expected) {
    full = true;
    error = errno;
  }
  if (full) cannot_write(folder_, reason(error == 0 ? ENOSPC : error));
  if (broken.bad()) return not_what_was_asked;
  DcmFileFormat header;
  const OFCondition read =
      header.loadFileUntilTag(part.path().c_str(), EXS_Unknown, EGL_noChange, 4096, ERM_autoDetect, DCM_SeriesNumber);
  OFString study, series;
  header.getDataset()->findAndGetOFString(DCM_StudyInstanceUID, study);
  header.getDataset()->findAndGetOFString(DCM_SeriesInstanceUID, series);
  const Header names{study.c_str(), series.c_str()};
  if (read.bad() || !is_wanted(names)) {
    unasked_.fetch_add(1, std::memory_order_relaxed);
    return not_what_was_asked;
  }
  instances_of_wanted_.insert(request.AffectedSOPInstanceUID);
  came_.store(instances_of_wanted_.size(), std::memory_order_relaxed);
  if (!instances_.insert(request.AffectedSOPInstanceUID).second) return STATUS_Success;  // sent again
  keep(part.path(), names);
  files_.fetch_add(1, std::memory_order_relaxed);
  bytes_.fetch_add(size, std::memory_order_relaxed);
  return STATUS_Success;
}

std::vector<FetchedSeries> Inbox::finish() {
  const std::lock_guard lock(mutex_);
  std::vector<FetchedSeries> result;
  std::size_t number = 0;
  try {
    for (auto& [uid, series] : series_) {
      fs::path place;
      do {
        place = folder_ / fmt::format("series-{:03}", ++number);
      } while (fs::exists(place));
      fs::rename(series.folder, place);
      result.push_back({uid, series.study_uid, place, series.files});
    }
  } catch (const fs::filesystem_error& error) {
    for (const FetchedSeries& series : result) fs::remove_all(series.folder);
    cannot_write(folder_, error.code().message());
  }
  series_.clear();
  return result;
}

}  // namespace palpate::io
