#pragma once

/// Which scan is in the views, and which comes next. Each is a variant of a few states, and each state holds exactly
/// the data that belong to it.

#include <QString>

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "plugin/paraview/client/model/scan_handle.h"

namespace palpate::plugin {

struct SeriesOnServer {
  std::string name;   ///< as scan_name()
  std::string label;  ///< as scan_label()
  bool usable = false;
};

/// The series that were found in a folder or file.
struct FoundList {
  std::string path;
  std::shared_ptr<const io::Catalogue> catalogue = {};  ///< null: a server's
  std::vector<SeriesOnServer> on_server = {};

  std::size_t count() const;
  /// The only one that is a volume; none if there are several, or none.
  std::optional<std::size_t> only() const;
  SeriesRef at(std::size_t series) const;
};

/// How a scan comes into the views.
enum class Brought {
  by_opening,  ///< its views were made for it
  by_state,    ///< a state file has restored reader, views and scene
  by_undo      ///< it was deleted from the pipeline, and that was undone
};

namespace in_views {

/// No scan is open.
struct Nothing {};

/// Its views are being made, one after the other. It cannot be felt yet.
struct Showing {
  SeriesRef of;
  std::shared_ptr<const io::Volume> volume;  ///< null: the server's
  int frame = 0;
};

/// Its views are complete, and its voxels are being fetched: from a server, or from the files that a state file names.
struct Fetching {
  SeriesRef of;
  bool from_server = false;
  Brought brought = Brought::by_opening;
  QString what = {};  ///< the current work
  double done = 0;
};

/// It is in the views, but its voxels cannot be obtained.
struct OutOfReach {
  SeriesRef of;
  QString why;
};

/// A frame whose voxels are being loaded.
struct ComingFrame {
  int frame = 0;
  std::shared_ptr<const io::Volume> volume = {};  ///< loaded, while the views do not yet show it
  QString what = {};
  double done = 0;
};

/// It is visible, and can be felt.
struct Shown {
  ScanHandle scan;
  Brought brought = Brought::by_opening;
  std::optional<ComingFrame> coming = {};
};

/// It was in the views, and has been removed from the pipeline.
struct Lost {
  SeriesRef of;
  QString why;
};

using State = std::variant<Nothing, Showing, Fetching, OutOfReach, Shown, Lost>;

}  // namespace in_views

namespace coming {

/// No folder is open.
struct Nothing {};

/// The series of a folder or file are being searched.
struct Finding {
  std::string path;
  double done = 0;
};

/// The series are listed for the user to choose; also after the choice.
struct Choosing {
  FoundList found;
};

/// The voxels of the chosen series are being read.
struct Loading {
  FoundList found;
  std::size_t series = 0;
  double done = 0;
};

using State = std::variant<Nothing, Finding, Choosing, Loading>;

}  // namespace coming

}  // namespace palpate::plugin
