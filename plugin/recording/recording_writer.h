#pragma once

/// Writes a growing recording, so that its flushed part stays readable after any failure.

#include <filesystem>
#include <memory>
#include <span>

#include "plugin/recording/recording.h"

namespace palpate::plugin {

/// Writes to `<file>.partial`. Every function throws std::runtime_error that names the file; after that only the
/// destructor may be called.
class RecordingWriter {
 public:
  RecordingWriter(std::filesystem::path file, const RecordingHeader& header);
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;
  /// Without finish(), leaves `<file>.partial` as it was when it was last flushed.
  ~RecordingWriter();

  /// Appends whole ticks with all their shares, and for each tick the uncertainty of the boundary
  /// (Recording::known_to_mm). If that list is empty, all are unknown.
  void append(std::span<const TickRecord> ticks, std::span<const PrimitiveRecord> shares,
              std::span<const double> known_to_mm = {});
  void append(const SceneRecord& scene);
  void append(const StylusRecord& stylus);
  void append(const Gap& gap);
  /// After this call, what was appended survives a crash of the process.
  void flush();
  /// Closes the file properly and gives it its name.
  void finish();
  /// The file before finish().
  const std::filesystem::path& partial() const noexcept { return partial_; }

 private:
  struct File;
  std::filesystem::path file_, partial_;
  std::unique_ptr<File> open_;
};

}  // namespace palpate::plugin
