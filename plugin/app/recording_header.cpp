#include "plugin/app/recording_header.h"

#include "modes/scene/scene_json.h"

namespace palpate::plugin {

RecordingHeader header_for(const modes::Scene& scene, const device::Specification& stylus, const std::string& scan_hash,
                           double seed) {
  return {.palpate_version = PALPATE_VERSION,
          .scene = modes::to_json(scene),
          .device = stylus.name,
          .scan_hash = scan_hash,
          .seed = seed,
          .rate_hz = stylus.rate};
}

}  // namespace palpate::plugin
