#include "plugin/app/vector_text.h"

#include <charconv>
#include <cmath>

#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {

glm::dvec3 parse_vector(const std::string& text, const std::string& option) {
  glm::dvec3 vector{0};
  const char* at = text.data();
  const char* const end = text.data() + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    if (at != end && *at == '+') ++at;  // from_chars takes a minus sign alone
    const auto [next, error] = std::from_chars(at, end, vector[axis]);
    const bool complete = axis == 2 ? next == end : next != end && *next == ',';
    if (error != std::errc{} || !complete || !std::isfinite(vector[axis])) {
      throw WrongUsage(at_place(option, say("not-a-point", text)));
    }
    at = next + 1;
  }
  return vector;
}

}  // namespace palpate::plugin
