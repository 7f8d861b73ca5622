#pragma once

/// Sends marks and measurements to an archive, in the background.

#include <memory>

#include "io/archive/send.h"
#include "io/series.h"
#include "io/volume.h"
#include "plugin/paraview/client/panel/work_bar.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin {

class MarksSender : public WorkBar {
  Q_OBJECT

 public:
  explicit MarksSender(QWidget* parent = nullptr);

  /// As `palpate export` followed by `palpate send`, through a temporary folder. `done`: everything is in the archive.
  void send(const io::Archive& archive, const io::Series& series, const std::shared_ptr<const io::Volume>& volume,
            const Marks& marks, std::function<void()> done);

 private:
  static Said said_of(const io::Sent& sent, const std::string& archive);
};

}  // namespace palpate::plugin
