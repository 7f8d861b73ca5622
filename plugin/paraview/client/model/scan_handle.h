#pragma once

/// The scan that is shown and felt: one handle for the reader, the views, the stylus and all other readers, so that
/// they agree on series and frame.

#include <QString>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

/// A series: its path, and its name there.
struct SeriesRef {
  std::string path;  ///< path of the folder or file, as seen by the program that reads it
  std::string name;  ///< as scan_name()
  QString label;     ///< as scan_label()
  std::shared_ptr<const io::Catalogue> catalogue = {};  ///< with this series; null: a server's
  std::size_t series = 0;                               ///< in the catalogue

  /// Null if only a server has them.
  const io::Series* details() const;
};

struct ScanHandle {
  SeriesRef of;
  QString series;                            ///< in words: modality, description, size. Names no patient
  std::shared_ptr<const io::Volume> volume;  ///< of that frame
  std::string scene;                         ///< the starting scene that suits it
  int frame = 0;                             ///< from 0
  int frames = 1;
  std::vector<std::string> frame_names;  ///< "b = 1000 s/mm2", one a frame, or fewer where unknown

  /// "b = 1000 s/mm2, 5 of 17", counted from 1; empty if there is one frame alone.
  QString frame_in_words() const { return frame_in_words(frame); }
  QString frame_in_words(int of_frame) const;
  /// Series and frame.
  QString in_words() const;
};

/// Modality and size, for a clinician: "CT, 64 slices of 96 x 80, every 2.5 mm". Names no patient.
QString size_in_words(const io::Volume& volume);

/// The handle of a volume of a series. `frames`: for a server's series; otherwise the catalogue has their number.
ScanHandle handle_of(const SeriesRef& of, std::shared_ptr<const io::Volume> volume, int frame, int frames);

}  // namespace palpate::plugin
