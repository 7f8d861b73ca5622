#pragma once

/// The scan that is shown and felt: one handle for the reader, the views, the stylus and whatever else reads it, so
/// that all of them mean the same series and the same frame.

#include <QString>

#include <memory>
#include <string>
#include <vector>

#include "io/volume.h"

namespace palpate::plugin {

struct ScanHandle {
  QString series;                            ///< in words: modality, description, size. Names no patient
  std::shared_ptr<const io::Volume> volume;  ///< of that frame; null: there is none to be felt
  std::string scene;                         ///< the starting scene that suits it
  int frame = 0;                             ///< from 0
  int frames = 1;
  std::vector<std::string> frame_names;  ///< "b = 1000 s/mm2", one a frame, or fewer where unknown

  /// "b = 1000 s/mm2, 5 of 17", counted from 1; empty where there is one frame alone.
  QString frame_in_words() const { return frame_in_words(frame); }
  QString frame_in_words(int of) const;
  /// Series and frame.
  QString in_words() const;
};

}  // namespace palpate::plugin
