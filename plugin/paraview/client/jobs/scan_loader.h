#pragma once

/// Finding, loading and studying scans in the background, so that the panel stays alive and a scan can be given up.

#include <QImage>
#include <QObject>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/filter.h"
#include "io/series.h"
#include "io/volume.h"
#include "plugin/paraview/client/jobs/scan_study.h"

namespace palpate::plugin {

/// A series here that may be the one on a server.
struct ScanCopy {
  std::shared_ptr<const io::Catalogue> catalogue;
  std::size_t series = 0;
};

/// One job at a time; a new one cancels the last. All callbacks come on the UI thread, none after destruction.
class ScanLoader {
 public:
  /// Empty where the job failed or was cancelled; then `error` says why, or is empty if it was cancelled.
  using Found = std::function<void(std::shared_ptr<const io::Catalogue>, const std::string& error)>;
  using Loaded = std::function<void(std::shared_ptr<const io::Volume>, const std::string& error)>;
  using Studied = std::function<void(std::shared_ptr<const ScanStudy>, const std::string& error)>;
  using Progress = std::function<void(double done)>;

  ScanLoader() = default;
  ScanLoader(const ScanLoader&) = delete;
  ScanLoader& operator=(const ScanLoader&) = delete;
  ~ScanLoader();

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
  /// One for each series, in their order, as they are drawn; empty ones where there is nothing to be shown. One or two
  /// may still come when the job was cancelled.
  void draw_thumbnails(std::shared_ptr<const io::Catalogue> catalogue,
                       std::function<void(std::size_t series, const QImage&)> drawn);
  void cancel();
  bool is_busy() const { return busy_; }

 private:
  template <typename Result, typename Work, typename Done>
  void start(Work work, Progress progress, Done done);

  std::thread thread_;
  std::shared_ptr<std::atomic<bool>> cancelled_ = std::make_shared<std::atomic<bool>>(false);
  bool busy_ = false;  // UI thread only
  QObject receiver_;   // its end ends the callbacks
};

}  // namespace palpate::plugin
