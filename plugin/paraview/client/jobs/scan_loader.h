#pragma once

/// Finds, loads and studies scans in the background, so that the panel stays responsive and the work can be cancelled.

#include <QImage>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/filter.h"
#include "io/series.h"
#include "io/volume.h"
#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/jobs/scan_study.h"

namespace palpate::plugin {

/// A local series that may be the same as one on a server.
struct ScanCopy {
  std::shared_ptr<const io::Catalogue> catalogue;
  std::size_t series = 0;
};

/// One job at a time: a new one cancels the previous one. All callbacks come on the UI thread, none after cancel() or
/// destruction.
class ScanLoader {
 public:
  /// Empty if the job failed or was cancelled; then `error` says why, or is empty if it was cancelled.
  using Found = std::function<void(std::shared_ptr<const io::Catalogue>, const std::string& error)>;
  using Loaded = std::function<void(std::shared_ptr<const io::Volume>, const std::string& error)>;
  using Studied = std::function<void(std::shared_ptr<const ScanStudy>, const std::string& error)>;
  using Progress = std::function<void(double done)>;

  ScanLoader() = default;

  void find(const std::string& path, Progress progress, Found found);
  /// Loads through a filter, if one is given.
  void load(const io::Series& series, int frame, const io::Filter& filter, Progress progress, Loaded loaded);
  void filter(std::shared_ptr<const io::Volume> volume, const io::Filter& filter, Progress progress, Loaded loaded);
  /// Finds series with that name (as scan_name()) and size in these folders and files; missing places are skipped.
  void find_copies(std::vector<std::string> places, const std::string& name, const glm::ivec3& size, Progress progress,
                   std::function<void(const std::vector<ScanCopy>&, const std::string& error)> found);
  /// Loads the first of them whose frame has that hash; null without an error if none has.
  void load_copy(std::vector<ScanCopy> copies, int frame, const std::string& hash, Progress progress, Loaded loaded);
  void study(std::shared_ptr<const io::Volume> volume, Progress progress, Studied studied);
  /// Draws one thumbnail for each series, in their order; empty if a series cannot be shown.
  void draw_thumbnails(std::shared_ptr<const io::Catalogue> catalogue,
                       std::function<void(std::size_t series, const QImage&)> drawn);
  void cancel() { job_.cancel(); }
  /// As Job::finish().
  void finish() { job_.finish(); }
  bool is_busy() const { return job_.is_busy(); }

 private:
  template <typename Work, typename Done>
  void start(Work work, Progress progress, Done done);

  Job job_;
};

}  // namespace palpate::plugin
