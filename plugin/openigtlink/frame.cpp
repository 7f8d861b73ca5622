#include "plugin/openigtlink/frame.h"

#include <glm/gtc/matrix_transform.hpp>

#include "plugin/openigtlink/message.h"
#include "plugin/openigtlink/names.h"

namespace palpate::plugin::igtl {
namespace {

const glm::dmat3 ras_from_lps{-1, 0, 0, 0, -1, 0, 0, 0, 1};

Transform at(const glm::dvec3& translation) {
  return {.rotation = glm::dmat3(1), .translation = translation};
}

}  // namespace

Frame frame_of(const TickRecord& tick, const std::optional<TickRecord>& before, const modes::Workspace& workspace,
               const std::optional<glm::dquat>& orientation) {
  Frame frame;
  const glm::dvec3 stylus = workspace.to_patient(vector_of(tick.probe_m));
  frame.stylus = at(ras_of(stylus));
  if (orientation) frame.stylus.rotation = ras_from_lps * workspace.rotation * glm::mat3_cast(*orientation);
  frame.proxy = at(ras_of(workspace.to_patient(vector_of(tick.proxy_m))));
  frame.force = at(ras_of(workspace.direction_to_patient(vector_of(tick.sent_n))));
  if (before && tick.time_s > before->time_s) {
    frame.velocity =
        at(ras_of(stylus - workspace.to_patient(vector_of(before->probe_m))) / (tick.time_s - before->time_s));
  }
  for (int button = 0; button < 3; ++button) {
    frame.buttons.rotation[0][button] = (tick.buttons >> static_cast<unsigned>(button) & 1U) != 0 ? 1 : 0;
  }
  return frame;
}

Bytes wire_of(const Frame& frame, double time_s) {
  Bytes wire;
  const auto add = [&](const char* device, const Transform& transform) {
    append(wire, {.type = "TRANSFORM", .device = device, .time_s = time_s, .content = content_of(transform)});
  };
  add(stylus_name, frame.stylus);
  add(proxy_name, frame.proxy);
  add(force_name, frame.force);
  add(velocity_name, frame.velocity);
  add(buttons_name, frame.buttons);
  return wire;
}

}  // namespace palpate::plugin::igtl
