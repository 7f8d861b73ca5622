#pragma once

/// Writes a recording as it comes, so that what was flushed can be read whatever happens next.

#include <filesystem>
#include <memory>
#include <span>

#include "plugin/recording/recording.h"

namespace palpate::plugin {

/// Writes to `<file>.partial`. All of it throws std::runtime_error naming the file; after that only abandon() and the
/// destructor may be called.
class RecordingWriter {
 public:
  RecordingWriter(std::filesystem::path file, const RecordingHeader& header);
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  /// Closes; `<file>.partial` stays unless it was finished or removed.
  ~RecordingWriter();

  /// Whole frames with all their shares.
  void append(std::span<const TickRecord> frames, std::span<const PrimitiveRecord> shares);
  void append(const SceneRecord& scene);
  void append(const StylusRecord& stylus);
  void append(const Gap& gap);
  /// From here on what was appended survives the process.
  void flush();
  /// Closes the file in good order and gives it its name.
  void finish();
  /// After a failure: leaves the file as it was when it was last flushed.
  void abandon() noexcept;
  /// Where it is written until it is finished.
  const std::filesystem::path& partial() const noexcept { return partial_; }

 private:
  struct File;
  std::filesystem::path file_, partial_;
  std::unique_ptr<File> open_;
};

}  // namespace palpate::plugin
