#pragma once

/// Shows what will be sent to an archive, and for which patient, before anything is sent.

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
  /// Texts shown beside patient, study and archive.
  struct Content {
    QString title, what, report, note;  ///< no report is shown if it is empty
  };
  static Content of_marks(const io::Series& series, const Marks& marks);
  static Content of_outline(const QString& structure, const QString& change);

  /// `archives`: the configured ones, at least one.
  SendDialog(const io::Series& series, const Content& content, std::vector<io::Archive> archives,
             QWidget* parent = nullptr);

  /// The chosen archive.
  const io::Archive& archive() const;

 private:
  std::vector<io::Archive> entered_;
  QComboBox* archives_;
};

}  // namespace palpate::plugin
