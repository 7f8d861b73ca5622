#include "plugin/paraview/client/model/playback.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/report/live_view.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {

void Playback::set_session(std::shared_ptr<const RecordedSession> session) {
  session_ = std::move(session);
  playing_ = seen_ = false;
  at_s_ = 0;
}

void Playback::play() {
  if (!session_) return;
  if (at_s_ >= session_->duration_s()) at_s_ = 0;
  playing_ = seen_ = true;
  clock_.start();
}

void Playback::seek(double seconds) {
  if (!session_) return;
  seen_ = true;
  at_s_ = std::clamp(seconds, 0.0, session_->duration_s());
  if (playing_) clock_.start();
}

void Playback::set_speed(double speed) {
  advance();
  speed_ = speed;
}

void Playback::advance() {
  if (!playing_) return;
  at_s_ += speed_ * static_cast<double>(clock_.restart()) / 1e3;
  if (at_s_ < session_->duration_s()) return;
  at_s_ = session_->duration_s();
  playing_ = false;
}

SessionStatus Playback::look(const std::string& unit) {
  SessionStatus look;
  if (!session_ || !seen_) return look;
  advance();
  const std::size_t n = session_->tick_at(at_s_);
  const auto shares = session_->shares(n);
  look.fresh = look.replayed = true;
  look.tick = session_->tick(n);
  look.shares.assign(shares.begin(), shares.end());
  look.workspace = session_->workspace(n);
  look.probe_mm = session_->probe_mm(n);
  look.proxy_mm = session_->proxy_mm(n);
  look.scene = std::shared_ptr<const modes::Scene>(session_, &session_->scene(n));
  look.nearest = nearest_structure(look.tick, *look.scene, session_->structures(n));
  look.tissue = tissue_name(*look.scene, unit, look.tick.value);
  look.force_n = look.peak_n = glm::length(session_->sent_n(n));
  look.tick_us = tick_us(look.tick);
  return look;
}

}  // namespace palpate::plugin
