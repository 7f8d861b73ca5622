#pragma once

/// What the model of the scan asks of the program around it. Every answer comes on the thread that asked, at once or
/// later; an answer to a request that was overtaken may come, and is ignored.

#include <QString>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/filter.h"
#include "plugin/paraview/client/model/scan_state.h"

namespace palpate::plugin {

/// What is seen of the scan that is shown, beside what was asked for: the user may change the pipeline, too.
struct ViewFacts {
  bool in_pipeline = false;
  bool seen = false;  ///< in any view on the screen
  std::string name;   ///< in the pipeline
  std::string other;  ///< another scan that is the active one there; empty: none
};

class ScanWorld {
 public:
  using Progress = std::function<void(const QString& what, double done)>;
  using Found = std::function<void(const FoundList& found, const std::string& error)>;
  using Loaded = std::function<void(const std::shared_ptr<const io::Volume>& volume, const std::string& error)>;
  using Made = std::function<void(const std::string& error)>;
  struct Fetch {
    std::shared_ptr<const io::Volume> volume;  ///< null: it could not be had
    QString said;                              ///< why, or where it comes from
    SeriesRef of;
    int frame = 0;
    int frames = 1;
  };
  using Fetched = std::function<void(const Fetch&)>;

  ScanWorld() = default;
  ScanWorld(const ScanWorld&) = delete;
  ScanWorld& operator=(const ScanWorld&) = delete;
  virtual ~ScanWorld() = default;

  /// Whether files are read by another program, a server. It blocks while it looks for series.
  virtual bool is_remote() const = 0;
  virtual void find(const std::string& path, Progress progress, Found found) = 0;
  virtual void load(const io::Series& series, int frame, Progress progress, Loaded loaded) = 0;
  /// Ends find() and load().
  virtual void stop() = 0;
  /// Another frame of the series that is shown, through a filter.
  virtual void load_frame(const io::Series& series, int frame, const io::Filter& filter, Loaded loaded) = 0;
  virtual void stop_frames() = 0;

  /// Makes a reader and its views, and closes those of before.
  virtual void show(const SeriesRef& of, int frame, Made made) = 0;
  /// Takes over the reader that stands in the pipeline, and its views as they are. Throws where they cannot be.
  virtual void adopt() = 0;
  /// Removes reader and views.
  virtual void close() = 0;
  /// The server has them no longer: forgets reader, views and what came from there.
  virtual void abandon() = 0;

  /// Brings the voxels of what is in the views; no frame: the one of ParaView's time. Files of this machine are read
  /// through the filter. Looks for a copy of a server's
  /// scan in these places of this machine.
  virtual void fetch(const SeriesRef& of, std::optional<int> frame, const io::Filter& filter,
                     std::vector<std::string> places, Progress progress, Fetched fetched) = 0;
  virtual void stop_fetching() = 0;

  /// Moves all views to a frame.
  virtual void show_frame(int frame) = 0;
  /// The frame that the views show.
  virtual int frame_in_views(int frames) const = 0;
  virtual ViewFacts facts() const = 0;
  /// What a user has to know of a scan in the views.
  virtual QString notes(const SeriesRef& of, const io::Volume* volume) const = 0;
};

}  // namespace palpate::plugin
