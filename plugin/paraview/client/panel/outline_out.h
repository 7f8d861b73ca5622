#pragma once

/// Writes a corrected outline to a file or sends it to an archive, in the background.

#include <filesystem>
#include <memory>

#include "io/archive/send.h"
#include "io/series.h"
#include "io/structures/label_image.h"
#include "io/volume.h"
#include "plugin/paraview/client/panel/work_bar.h"

namespace palpate::plugin {

/// The field of a corrected structure, and the scan on which it was corrected.
struct CorrectedOutline {
  io::Structure structure;
  std::shared_ptr<const io::DistanceField> distance;
  io::Series series;  ///< without images if they are only on a server: then DICOM cannot be written
  int frame = 0;
  std::shared_ptr<const io::Volume> scan;
};

class OutlineOut : public WorkBar {
  Q_OBJECT

 public:
  explicit OutlineOut(QWidget* parent = nullptr);

  /// As `palpate correct` writes it. `overwrite`: the user has agreed. `done`: the file is written.
  void save(const CorrectedOutline& outline, const std::filesystem::path& file, bool as_contours, bool overwrite,
            std::function<void()> done);
  /// As a DICOM SEG, through a temporary folder. `done`: it is in the archive.
  void send(const CorrectedOutline& outline, const io::Archive& archive, std::function<void()> done);
};

}  // namespace palpate::plugin
