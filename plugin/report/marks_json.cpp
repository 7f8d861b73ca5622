#include "plugin/report/marks_json.h"

#include <cmath>

namespace palpate::plugin {

using Json = nlohmann::ordered_json;

Json json_of(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json json_of(const FeltMark& mark) {
  return {{"name", mark.name},         {"tick", mark.tick},
          {"time_s", mark.time_s},     {"position_mm", json_of(mark.position_mm)},
          {"boundary", mark.boundary}, {"value", std::isfinite(mark.value) ? Json(mark.value) : Json()},
          {"force_n", mark.force_n}};
}

}  // namespace palpate::plugin
