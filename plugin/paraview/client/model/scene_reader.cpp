#include "plugin/paraview/client/model/scene_reader.h"

#include <exception>
#include <utility>

#include "modes/scene/scene_json.h"

namespace palpate::plugin {

bool SceneReader::read(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& scan,
                       std::function<void(const QString& error)> done) {
  if (!scan) return false;
  const std::string just_read = std::exchange(just_read_, {});
  if (!just_read.empty() && held_of_.lock() == scan && just_read == modes::to_json(scene)) return false;
  try {
    if (live_.has_read(scene, scan)) return false;
  } catch (const std::exception&) {
    return false;  // it is refused
  }
  if (held_of_.lock() != scan) held_.clear();
  held_of_ = scan;
  const auto finish = [this, text = modes::to_json(scene), done = std::move(done)](const auto& read,
                                                                                   const QString& error) {
    if (read) {
      held_.insert(held_.end(), read->structures.begin(), read->structures.end());
      live_.offer(PreparedScene(*read));
    }
    just_read_ = read ? text : std::string();
    done(error);
    just_read_.clear();
  };
  job_.ask(live_.reading(scene, scan), finish);
  return true;
}

bool SceneReader::cancel() {
  const bool was_busy = job_.is_busy();
  job_.cancel();
  return was_busy;
}

}  // namespace palpate::plugin
