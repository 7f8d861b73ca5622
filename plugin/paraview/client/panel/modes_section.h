#pragma once

/// The panel's fifth section: all modes of the scene with their parameters, and the parts that the plan leaves out.

#include <QWidget>

#include "plugin/paraview/client/model/session_controller.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QListWidget;
class QToolButton;

namespace palpate::plugin {

class ModesSection : public QWidget {
  Q_OBJECT

 public:
  ModesSection(SceneModel& model, SessionController& session, QWidget* parent = nullptr);

  /// Shows the plan again.
  void refresh();
  /// Shows the parts that the plan leaves out; they are for developers.
  void show_technical(bool shown);

 private:
  /// The callback of a change: if it is refused, the widgets return to the felt values.
  SceneModel::Told told();
  void build_parameters(QWidget& parent);
  void list_modes();
  void show_mode();
  void add_mode(const std::string& type);
  void remove_mode();
  std::size_t mode() const;
  void set(const QString& what, const std::function<void(modes::Mode&)>& change);

  SceneModel& model_;
  SessionController& session_;
  QListWidget* list_;
  QLabel* summary_;
  QComboBox* side_;
  QComboBox* from_;
  QComboBox* to_;
  QComboBox* shape_;
  QComboBox* direction_;
  QDoubleSpinBox* strength_;
  QToolButton* here_;
  QLabel* message_ = nullptr;
  QLabel* plan_;
  bool listing_ = false;
};

}  // namespace palpate::plugin
