#pragma once

/// What stays in sight whatever is folded: what is felt, and the way out.

#include <QWidget>

#include "plugin/paraview/client/panel/session_controller.h"

class QLabel;
class QPushButton;

namespace palpate::plugin {

class ForceStrip;

class Footer : public QWidget {
  Q_OBJECT

 public:
  explicit Footer(SessionController& touching, const SceneModel& model, QWidget* parent = nullptr);

  /// What is felt, in words: scan, frame, scene.
  void set_felt(const QString& words);

 private:
  void show_look(const SessionStatus& look);
  void show_state(const SessionStatus& look);
  void show_distance(const SessionStatus& look);
  void show_connection();
  void toggle_recording();

  SessionController& touching_;
  const SceneModel& model_;
  QLabel* tissue_;
  QLabel* force_;
  QLabel* depth_;
  QLabel* distance_ = nullptr;
  QLabel* solver_;
  QLabel* tick_;
  ForceStrip* strip_;
  QPushButton* record_;
  QPushButton* release_;
  QPushButton* feel_ = nullptr;
  QLabel* lamp_ = nullptr;
  QLabel* state_ = nullptr;
  QLabel* felt_ = nullptr;
};

}  // namespace palpate::plugin
