#pragma once

/// The one toolbar of the clinical layout: what is pressed while a scan is looked at and felt.

#include <QToolBar>

#include <functional>

class QAction;
class QComboBox;
class QPushButton;

namespace palpate::plugin {

class ClinicalToolbar : public QToolBar {
  Q_OBJECT

 public:
  /// The boxes of gray windows and of the volume's looks come to stand here.
  ClinicalToolbar(QComboBox& window, QComboBox& look, QWidget* parent);

  /// How it is connected now, and whether that can be changed.
  void show_connection(bool connected, bool can_connect);
  void show_enlarged(bool enlarged);
  void show_advanced(bool advanced);

 signals:
  void open_wanted();
  void folder_wanted(const QString& folder);
  void picture_wanted();
  void enlarged_wanted(bool enlarged);
  void connect_wanted();
  void release_wanted();
  void advanced_wanted(bool advanced);

 private:
  QAction* add(const char* name, const QString& text, const QString& tip);

  QAction* four_ = nullptr;
  QAction* one_ = nullptr;
  QAction* connect_ = nullptr;
  QAction* advanced_ = nullptr;
  QPushButton* release_ = nullptr;
};

}  // namespace palpate::plugin
