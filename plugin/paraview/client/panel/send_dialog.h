#pragma once

/// What is about to go into an archive, and for whom: shown before anything is sent.

#include <QDialog>

#include <optional>
#include <vector>

#include "io/archive/archive.h"
#include "io/series.h"
#include "plugin/recording/marks.h"

class QComboBox;

namespace palpate::plugin {

class SendDialog : public QDialog {
  Q_OBJECT

 public:
  /// `archives`: those that were entered, not empty.
  SendDialog(const io::Series& series, const Marks& marks, std::vector<io::Archive> archives,
             QWidget* parent = nullptr);

  /// The one that is chosen.
  const io::Archive& archive() const;

 private:
  std::vector<io::Archive> entered_;
  QComboBox* archives_;
};

}  // namespace palpate::plugin
