#pragma once

/// The panel's fifth section: every mode of the scene with its parameters, and what the plan leaves out.

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

  /// The plan is shown anew.
  void refresh();
  /// What the plan leaves out is for developers.
  void show_technical(bool shown);

 private:
  /// What a change is told: a refused one goes back to what is felt.
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
