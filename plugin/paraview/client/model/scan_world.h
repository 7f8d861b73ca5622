#pragma once

/// The services that the scan model needs from the program around it. Every answer comes on the thread that asked, at
/// once or later. Answers to outdated requests may come, and are ignored.

#include <QString>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/filter.h"
#include "plugin/paraview/client/model/scan_state.h"

namespace palpate::plugin {

/// What the views really show, which may differ from what was requested: the user may also change the pipeline.
struct ViewFacts {
  bool in_pipeline = false;
  bool seen = false;  ///< in any view on the screen
  std::string name;   ///< in the pipeline
  std::string other;  ///< another scan that is active there; empty: none
};

class ScanWorld {
 public:
  using Progress = std::function<void(const QString& what, double done)>;
  using Found = std::function<void(const FoundList& found, const std::string& error)>;
  using Loaded = std::function<void(const std::shared_ptr<const io::Volume>& volume, const std::string& error)>;
  using Made = std::function<void(const std::string& error)>;
  struct Fetch {
    std::shared_ptr<const io::Volume> volume;  ///< null: not available
    QString said;                              ///< why, or its source
    SeriesRef of;
    int frame = 0;
    int frames = 1;
  };
  using Fetched = std::function<void(const Fetch&)>;

  ScanWorld() = default;
  ScanWorld(const ScanWorld&) = delete;
  ScanWorld& operator=(const ScanWorld&) = delete;
  virtual ~ScanWorld() = default;

  /// Whether another program, a server, reads the files. Then the search for series blocks.
  virtual bool is_remote() const = 0;
  virtual void find(const std::string& path, Progress progress, Found found) = 0;
  virtual void load(const io::Series& series, int frame, Progress progress, Loaded loaded) = 0;
  /// Cancels running calls of find() and load().
  virtual void stop() = 0;
  /// Loads another frame of the series that is shown, through a filter.
  virtual void load_frame(const io::Series& series, int frame, const io::Filter& filter, Loaded loaded) = 0;
  virtual void stop_frames() = 0;

  /// Makes a reader and its views, and closes the previous ones.
  virtual void show(const SeriesRef& of, int frame, Made made) = 0;
  /// Takes over the pipeline's reader, and its views as they are. Throws if that is impossible.
  virtual void adopt() = 0;
  /// Removes reader and views.
  virtual void close() = 0;
  /// The server has lost them: forgets reader, views and everything that came from there.
  virtual void abandon() = 0;

  /// Fetches the voxels of the scan in the views; without `frame`, of the frame at ParaView's time. Files of this
  /// machine are read through the filter. For a server's scan, searches these places of this machine for a copy.
  virtual void fetch(const SeriesRef& of, std::optional<int> frame, const io::Filter& filter,
                     std::vector<std::string> places, Progress progress, Fetched fetched) = 0;
  virtual void stop_fetching() = 0;

  /// Moves all views to a frame.
  virtual void show_frame(int frame) = 0;
  /// The frame that the views show.
  virtual int frame_in_views(int frames) const = 0;
  virtual ViewFacts facts() const = 0;
  /// What the user has to know about a scan in the views.
  virtual QString notes(const SeriesRef& of, const io::Volume* volume) const = 0;
};

}  // namespace palpate::plugin
