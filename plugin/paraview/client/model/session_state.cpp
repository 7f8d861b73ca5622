#include "plugin/paraview/client/model/session_state.h"

#include <QCoreApplication>

#include "device/safety/safety_filter.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/words.h"
#include "plugin/session/session.h"

namespace palpate::plugin {
namespace {

QString translated(const char* text) {
  return QCoreApplication::translate("SessionState", text);
}

}  // namespace

StateLine state_line_of(const SessionStatus& look) {
  if (!look.connected) return {SessionState::off, translated("Off: no stylus is connected")};
  const device::Fault fault = look.fresh ? fault_of(look.tick) : device::Fault::none;
  const bool latched = fault != device::Fault::none;
  if (!look.kept_off.isEmpty()) {
    return {SessionState::stopped, translated("Stopped: %1").arg(look.kept_off), latched};
  }
  if (latched) {
    const auto device = static_cast<device::State>(look.tick.stylus_state);
    const bool lost = device == device::State::fault || device == device::State::disconnected;
    const QString advice = words(device::advice_for(fault));
    // The stylus may know more than that it is lost.
    QString why = lost && !look.trouble.isEmpty() ? look.trouble : advice;
    if (fault == device::Fault::commander_silent && !look.held_up.isEmpty()) {
      why += QStringLiteral(" (%1)").arg(look.held_up);
    }
    return {SessionState::stopped, translated("Stopped: %1").arg(why), true, lost};
  }
  if (look.clutched) return {SessionState::ready, translated("Ready: clutched, move your hand or the view freely")};
  if (!look.fresh) return {SessionState::ready, translated("Ready: the stylus is starting")};
  switch (state_of(look.tick)) {
    case device::State::homing:
      return {SessionState::ready, look.homing.isEmpty()
                                       ? translated("Ready: homing, move the stylus as its maker says")
                                       : translated("Ready: to home it, %1").arg(look.homing)};
    case device::State::active:
    case device::State::ramping:
    case device::State::idle:
      break;
    case device::State::disconnected:
    case device::State::fault:
      return {SessionState::stopped,
              translated("Stopped: the stylus does not answer. Check its plug and power, then connect it again")};
  }
  const bool full = state_of(look.tick) == device::State::active;
  if (look.feels && look.is_warm) {
    return {SessionState::feeling,
            translated("Feeling: the motors are warm, so the force is only %1 N").arg(look.force_n, 0, 'f', 1)};
  }
  if (look.feels) {
    return {SessionState::feeling,
            full ? translated("Feeling: forces are on") : translated("Feeling: forces are coming up")};
  }
  return {SessionState::ready, state_of(look.tick) == device::State::idle
                                   ? translated("Ready: no force. Feel turns it on")
                                   : translated("Ready: the force is going down")};
}

}  // namespace palpate::plugin
