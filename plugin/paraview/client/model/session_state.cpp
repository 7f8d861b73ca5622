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

/// A force that may still act is said first.
QString stopped(const SessionStatus& look, const QString& why) {
  return (look.may_push ? translated("Stopped: the stylus may still push. Switch its power off. %1")
                        : translated("Stopped: %1"))
      .arg(why);
}

}  // namespace

bool is_lost(const TickRecord& tick) {
  const auto stylus = static_cast<device::State>(tick.stylus_state);
  return stylus == device::State::fault || stylus == device::State::disconnected;
}

StateLine state_line_of(const SessionStatus& look) {
  if (!look.connected) return {SessionState::off, translated("Off: no stylus is connected")};
  const device::Fault fault = look.fresh ? fault_of(look.tick) : device::Fault::none;
  const bool latched = fault != device::Fault::none;
  // Without a force nothing is latched by a loss.
  const bool lost = look.fresh && is_lost(look.tick);
  if (!look.kept_off.isEmpty()) {
    return {SessionState::stopped, stopped(look, look.kept_off), latched, lost};
  }
  if (latched || lost) {
    QString why = latched ? words(device::advice_for(fault))
                          : translated("The stylus does not answer: check its plug and power, then open it again.");
    // The stylus may know more than that it is lost.
    if (lost && !look.trouble.isEmpty()) why = look.trouble;
    if (fault == device::Fault::commander_silent && !look.held_up.isEmpty()) {
      why += QStringLiteral(" (%1)").arg(look.held_up);
    }
    return {SessionState::stopped, stopped(look, why), latched, lost};
  }
  if (look.clutched) return {SessionState::ready, translated("Ready: clutched, move your hand or the view freely")};
  if (!look.fresh) return {SessionState::ready, translated("Ready: the stylus is starting")};
  if (state_of(look.tick) == device::State::homing) {
    return {SessionState::ready, look.homing.isEmpty() ? translated("Ready: homing, move the stylus as its maker says")
                                                       : translated("Ready: to home it, %1").arg(look.homing)};
  }
  const bool full = state_of(look.tick) == device::State::active && !look.is_held_back;
  if (look.feels && look.is_warm && !look.is_held_back) {
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
