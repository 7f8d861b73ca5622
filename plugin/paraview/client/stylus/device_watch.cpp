#include "plugin/paraview/client/stylus/device_watch.h"

#include <QDir>

namespace palpate::plugin {

namespace {

constexpr int glance_ms = 1000;
constexpr int glances_until_again = 3;

/// The names of plugged-in devices, which are cheap to read; $PALPATE_PLUGGED names folders to be used instead of the
/// kernel's.
QStringList plugged_now() {
  const QString named = QString::fromLocal8Bit(qgetenv("PALPATE_PLUGGED"));
  const QString folders = named.isEmpty() ? QStringLiteral("/sys/bus/usb/devices:/sys/class/hidraw") : named;
  QStringList names;
  for (const QString& folder : folders.split(QLatin1Char(':'))) {
    names += QDir(folder).entryList(QDir::AllEntries | QDir::NoDotAndDotDot | QDir::System, QDir::Name);
  }
  return names;
}

}  // namespace

DeviceWatch::DeviceWatch(QObject* parent) : QObject(parent) {
  connect(&glances_, &QTimer::timeout, this, [this] { glance(); });
  glances_.start(glance_ms);
}

void DeviceWatch::look() {
  ask(true);
}

void DeviceWatch::glance() {
  const bool once_more = again_ > 0 && --again_ == 0;
  ask(once_more);
}

void DeviceWatch::ask(bool whatever_is_plugged) {
  const auto look_now = [before = plugged_, whatever_is_plugged] {
    Seen seen;
    seen.plugged = plugged_now();
    seen.looked = whatever_is_plugged || seen.plugged != before;
    if (seen.looked) seen.devices = device::find_devices();
    return seen;
  };
  job_.ask(look_now, [this](const std::shared_ptr<const Seen>& seen, const QString&) {
    if (!seen) return;
    if (seen->plugged != plugged_) again_ = glances_until_again;
    plugged_ = seen->plugged;
    if (seen->looked) emit found(seen->devices);
  });
}

}  // namespace palpate::plugin
