#pragma once

/// The fields of what is searched for in an archive.

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

  /// None while a date is begun and not whole, unless that is asked for: the archive's code then says what a date is.
  std::optional<io::ArchiveQuery> query(bool begun_date) const;
  void focus();

 signals:
  /// A while after something was typed, or at once where it is asked for.
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
