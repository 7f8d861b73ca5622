#include "plugin/recording/recorded_session.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/messages/messages.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {
namespace {

/// Keeps only the ticks of these scenes, and their shares.
std::size_t leave_out_others(Recording& recording, const std::set<std::uint32_t>& epochs) {
  std::vector<PrimitiveRecord> shares;
  std::size_t kept = 0, share = 0;
  for (const TickRecord& tick : recording.ticks) {
    const std::size_t next = share + tick.share_count;
    if (epochs.count(tick.scene_epoch) > 0) {
      shares.insert(shares.end(), recording.shares.begin() + static_cast<std::ptrdiff_t>(share),
                    recording.shares.begin() + static_cast<std::ptrdiff_t>(next));
      recording.ticks[kept++] = tick;
    }
    share = next;
  }
  const std::size_t left_out = recording.ticks.size() - kept;
  recording.ticks.resize(kept);
  recording.shares = std::move(shares);
  return left_out;
}

}  // namespace

RecordedSession::RecordedSession(Recording recording, const io::Volume& volume) : recording_(std::move(recording)) {
  const std::string hash = hash_of(volume);
  std::set<std::uint32_t> here;
  for (const SceneRecord& record : recording_.scenes) {
    if (record.scan_hash == hash) here.insert(record.epoch);
  }
  elsewhere_ = leave_out_others(recording_, here);
  if (recording_.ticks.empty()) {
    throw Refusal(elsewhere_ == 0 ? say("recording-is-empty")
                                  : say("recorded-on-another-scan-open", recording_.header.scan_hash, hash));
  }
  first_share_.reserve(size());
  std::size_t share = 0;
  std::uint32_t last = recording_.ticks.front().scene_epoch;
  for (const TickRecord& tick : recording_.ticks) {
    first_share_.push_back(share);
    share += tick.share_count;
    const auto [known, is_new] = settings_.try_emplace(tick.scene_epoch);
    if (!is_new) continue;
    const SceneRecord& record = *std::find_if(recording_.scenes.begin(), recording_.scenes.end(),
                                              [&](const auto& r) { return r.epoch == tick.scene_epoch; });
    Setting& setting = known->second;
    setting.scene = modes::scene_from_json(record.scene, "the recording's scene");
    const auto plan = plan_for(setting.scene, volume, record.half_extent_m);
    setting.workspace = plan->workspace;
    setting.structures = plan->structures;
    // At the start of a change, the old workspace is the previous tick's.
    setting.before = settings_.at(last).workspace;
    last = tick.scene_epoch;
  }
}

double RecordedSession::time_s(std::size_t n) const noexcept {
  return recording_.ticks[n].time_s - recording_.ticks.front().time_s;
}

double RecordedSession::duration_s() const noexcept {
  return time_s(size() - 1);
}

std::size_t RecordedSession::tick_at(double seconds) const noexcept {
  const double at = recording_.ticks.front().time_s + seconds;
  const auto later = std::upper_bound(recording_.ticks.begin(), recording_.ticks.end(), at,
                                      [](double time, const TickRecord& tick) { return time < tick.time_s; });
  return later == recording_.ticks.begin() ? 0 : static_cast<std::size_t>(later - recording_.ticks.begin()) - 1;
}

std::span<const PrimitiveRecord> RecordedSession::shares(std::size_t n) const {
  return std::span(recording_.shares).subspan(first_share_[n], recording_.ticks[n].share_count);
}

const modes::Scene& RecordedSession::scene(std::size_t n) const {
  return setting(n).scene;
}

modes::Workspace RecordedSession::workspace(std::size_t n) const {
  const Setting& at = setting(n);
  return modes::between(at.before, at.workspace, recording_.ticks[n].change_part);
}

glm::dvec3 RecordedSession::probe_mm(std::size_t n) const {
  return workspace(n).to_patient(vector_of(recording_.ticks[n].probe_m));
}

glm::dvec3 RecordedSession::proxy_mm(std::size_t n) const {
  return workspace(n).to_patient(vector_of(recording_.ticks[n].proxy_m));
}

glm::dvec3 RecordedSession::sent_n(std::size_t n) const {
  return workspace(n).direction_to_patient(vector_of(recording_.ticks[n].sent_n));
}

}  // namespace palpate::plugin
