#pragma once

/// What is about to go into an archive, and for whom: shown before anything is sent.

#include <QDialog>
#include <QString>

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
  /// What is told beside patient, study and archive.
  struct Content {
    QString title, what, report, note;  ///< without a report none is shown
  };
  static Content of_marks(const io::Series& series, const Marks& marks);
  static Content of_outline(const QString& structure, const QString& change);

  /// `archives`: those that were entered, not empty.
  SendDialog(const io::Series& series, const Content& content, std::vector<io::Archive> archives,
             QWidget* parent = nullptr);

  /// The one that is chosen.
  const io::Archive& archive() const;

 private:
  std::vector<io::Archive> entered_;
  QComboBox* archives_;
};

}  // namespace palpate::plugin
