#pragma once

/// Finding, loading and studying scans in the background, so that the panel stays alive and a scan can be given up.

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

/// A series here that may be the one on a server.
struct ScanCopy {
  std::shared_ptr<const io::Catalogue> catalogue;
  std::size_t series = 0;
};

/// One at a time: a new one cancels the last. All callbacks come on the UI thread, none after cancel() or destruction.
class ScanLoader {
 public:
  /// Empty if the job failed or was cancelled; then `error` says why, or is empty if it was cancelled.
  using Found = std::function<void(std::shared_ptr<const io::Catalogue>, const std::string& error)>;
  using Loaded = std::function<void(std::shared_ptr<const io::Volume>, const std::string& error)>;
  using Studied = std::function<void(std::shared_ptr<const ScanStudy>, const std::string& error)>;
  using Progress = std::function<void(double done)>;

  ScanLoader() = default;

  void find(const std::string& path, Progress progress, Found found);
  /// Through a filter, where one is given.
  void load(const io::Series& series, int frame, const io::Filter& filter, Progress progress, Loaded loaded);
  void filter(std::shared_ptr<const io::Volume> volume, const io::Filter& filter, Progress progress, Loaded loaded);
  /// Series of that name (as scan_name()) and size in these folders and files; what is not there is passed over.
  void find_copies(std::vector<std::string> places, const std::string& name, const glm::ivec3& size, Progress progress,
                   std::function<void(const std::vector<ScanCopy>&, const std::string& error)> found);
  /// The first of them whose frame has that hash; none, without an error, where none has.
  void load_copy(std::vector<ScanCopy> copies, int frame, const std::string& hash, Progress progress, Loaded loaded);
  void study(std::shared_ptr<const io::Volume> volume, Progress progress, Studied studied);
  /// One for each series, in their order, as they are drawn; empty ones where there is nothing to be shown.
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
