#pragma once

/// Plays a recording in the views, at a chosen speed and from any position. No force is felt.

#include <QElapsedTimer>

#include <memory>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/recording/recorded_session.h"

namespace palpate::plugin {

class Playback {
 public:
  /// The recording to play; null: none. It starts paused at its beginning, and becomes visible when it is played or
  /// moved.
  void set_session(std::shared_ptr<const RecordedSession> session);
  const std::shared_ptr<const RecordedSession>& session() const { return session_; }

  /// Plays; from the beginning if it is at its end.
  void play();
  void pause() { playing_ = false; }
  bool is_playing() const { return playing_; }
  void seek(double seconds);
  /// Playback speed: 1 is as recorded.
  void set_speed(double speed);
  double at_s() const { return at_s_; }

  /// The status at the present position.
  SessionStatus look(const std::string& unit);

 private:
  void advance();

  std::shared_ptr<const RecordedSession> session_;
  double at_s_ = 0, speed_ = 1;
  bool playing_ = false, seen_ = false;
  QElapsedTimer clock_;
};

}  // namespace palpate::plugin
