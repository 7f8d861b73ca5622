#pragma once

/// Sends what was marked into an archive, in the background: a bar that shows how far it is, and can be cancelled.

#include <QWidget>

#include <memory>

#include "io/archive/send.h"
#include "io/series.h"
#include "io/volume.h"
#include "plugin/paraview/client/jobs/background.h"
#include "plugin/recording/marks.h"

class QProgressBar;

namespace palpate::plugin {

class MarksSender : public QWidget {
  Q_OBJECT

 public:
  explicit MarksSender(QWidget* parent = nullptr);

  /// As `palpate export` and `palpate send` do, from a folder that is gone afterwards.
  void send(const io::Archive& archive, const io::Series& series, const std::shared_ptr<const io::Volume>& volume,
            const Marks& marks);
  bool is_busy() const { return sending_.is_busy(); }

 signals:
  void told(const QString& message, bool problem);

 private:
  void take(const io::Sent& sent, const std::string& archive);

  QProgressBar* progress_;
  Background<io::Sent> sending_;
};

}  // namespace palpate::plugin
