#pragma once

/// The part of the panel that always stays visible: what is felt, and the button that releases the force.

#include <QWidget>

#include "plugin/paraview/client/model/session_controller.h"

class QGridLayout;
class QLabel;
class QLayout;
class QPushButton;
class QToolButton;

namespace palpate::plugin {

class ForceStrip;

class Footer : public QWidget {
  Q_OBJECT

 public:
  explicit Footer(SessionController& session, const SceneModel& model, QWidget* parent = nullptr);

  /// What is felt, in words: scan, frame, scene; and whether there is a scan.
  /// While an outline is corrected, the mark button corrects it.
  void set_corrects(bool corrects);
  void set_felt(const QString& words, bool scan_open);
  /// Whether details for developers are shown.
  bool is_technical() const;

 signals:
  void technical_changed(bool shown);

 private:
  void add_values(QGridLayout& grid);
  void add_technical(QGridLayout& grid);
  QLayout* make_state();
  QLayout* make_buttons();
  void show_look(const SessionStatus& look);
  void show_state(const SessionStatus& look);
  /// Whether the ticks are of the open scan, and not of one that is gone or of the one before.
  bool is_of_the_scan() const;
  void show_distance(const SessionStatus& look);
  void show_technical(bool shown);
  void show_connection();
  void toggle_recording();

  SessionController& session_;
  const SceneModel& model_;
  QLabel* tissue_ = nullptr;
  QLabel* force_ = nullptr;
  QLabel* depth_ = nullptr;
  QLabel* distance_ = nullptr;
  QLabel* solver_ = nullptr;
  QLabel* tick_ = nullptr;
  QToolButton* technical_ = nullptr;
  ForceStrip* strip_ = nullptr;
  QPushButton* record_ = nullptr;
  QPushButton* release_ = nullptr;
  QPushButton* feel_ = nullptr;
  QPushButton* mark_ = nullptr;
  QLabel* lamp_ = nullptr;
  QLabel* state_ = nullptr;
  QLabel* felt_ = nullptr;
  bool scan_open_ = false;
};

}  // namespace palpate::plugin
