#pragma once

/// The fields of a search in an archive.

#include <QTimer>
#include <QWidget>

#include <optional>

#include "io/archive/find.h"

class QComboBox;
class QLineEdit;

namespace palpate::plugin {

class ArchiveSearch : public QWidget {
  Q_OBJECT

 public:
  explicit ArchiveSearch(QWidget* parent = nullptr);

  /// The query; none while a date is incomplete. With `begun_date` the incomplete date is passed on, so that the
  /// archive's code explains the format of dates.
  std::optional<io::ArchiveQuery> query(bool begun_date) const;
  void focus();

 signals:
  /// Emitted a while after typing, or at once on request.
  void wanted(bool begun_date);

 private:
  QLineEdit* field(const char* name, const QString& what, const QString& tip);

  QLineEdit* patient_;
  QLineEdit* id_;
  QLineEdit* description_;
  QLineEdit* date_;
  QComboBox* modality_;
  QTimer typing_;
};

}  // namespace palpate::plugin
