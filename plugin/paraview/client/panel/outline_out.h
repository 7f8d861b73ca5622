#pragma once

/// Writes a corrected outline into a file or sends it to an archive, in the background.

#include <filesystem>
#include <memory>

#include "io/archive/send.h"
#include "io/series.h"
#include "io/structures/label_image.h"
#include "io/volume.h"
#include "plugin/paraview/client/panel/work_bar.h"

namespace palpate::plugin {

/// A structure as it is felt, and the scan that it was corrected on.
struct CorrectedOutline {
  io::Structure structure;
  std::shared_ptr<const io::DistanceField> distance;
  io::Series series;  ///< without images where they are on a server alone: no DICOM can be written
  int frame = 0;
  std::shared_ptr<const io::Volume> scan;
};

class OutlineOut : public WorkBar {
  Q_OBJECT

 public:
  explicit OutlineOut(QWidget* parent = nullptr);

  /// As `palpate correct` writes it. `overwrite`: the user was asked. `done`: it is written.
  void save(const CorrectedOutline& outline, const std::filesystem::path& file, bool as_contours, bool overwrite,
            std::function<void()> done);
  /// As a DICOM SEG, from a folder that is gone afterwards. `done`: it is there.
  void send(const CorrectedOutline& outline, const io::Archive& archive, std::function<void()> done);
};

}  // namespace palpate::plugin
