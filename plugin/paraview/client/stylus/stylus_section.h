#pragma once

/// The panel's third section: the choice of stylus, its state, and the mapping of the scan to the hand.

#include <QWidget>

#include <functional>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/stylus/device_watch.h"
#include "plugin/paraview/client/stylus/mapping.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QToolButton;

namespace palpate::device {
struct DeviceType;
}

namespace palpate::plugin {

class StylusSection : public QWidget {
  Q_OBJECT

 public:
  /// `eye` returns the viewpoint of the 3D view.
  StylusSection(SessionController& session, SceneModel& model, std::function<Eye()> eye, QWidget* parent = nullptr);

  /// Whether the slices follow the stylus now: not while the user browses them.
  bool slices_follow() const;
  /// The user browses slices: they stay until *Go to stylus*.
  void pause_following();
  /// Connects the chosen stylus, or disconnects it.
  void connect_or_not();
  /// Shows the stylus' own limits; they are for developers.
  void show_technical(bool shown);

 signals:
  /// The slices through the stylus are to be shown.
  void stylus_wanted();
  /// Whether a stylus is connected, and whether connect_or_not() can change that.
  void connection_shown(bool held, bool can_change);

 private:
  void build_connection(QWidget& parent);
  void build_limits();
  void build_workspace();
  void show_devices(const std::vector<device::FoundDevice>& found);
  void show_choice();
  void show_connection();
  const device::DeviceType* chosen_type() const;
  void show_own();
  /// The callback of a change: if it is refused, the widgets return to the felt values.
  SceneModel::Told told();
  QString tested() const;
  QString unguarded() const;
  QStringList without_program(const device::Specification& stylus) const;
  void show_scene();
  void show_look(const SessionStatus& look);
  void remap(const QString& what, const modes::WorkspaceSettings& settings);
  void clutch(bool on);
  void go_to_stylus();

  SessionController& session_;
  SceneModel& model_;
  std::function<Eye()> eye_;
  DeviceWatch watch_;
  QComboBox* device_ = nullptr;
  QLineEdit* file_ = nullptr;
  QPushButton* connect_ = nullptr;
  QDoubleSpinBox* stiffness_ = nullptr;
  QDoubleSpinBox* limit_ = nullptr;
  QLabel* own_ = nullptr;
  QLabel* scale_ = nullptr;
  QToolButton* fits_[3] = {};
  QPushButton* clutch_ = nullptr;
  QCheckBox* turn_ = nullptr;
  QCheckBox* follow_ = nullptr;
  QToolButton* go_ = nullptr;
  QLabel* message_ = nullptr;
  bool leafing_ = false;
  bool technical_ = false;
};

}  // namespace palpate::plugin
