#pragma once

/// Searches for styluses in a thread of its own: on request, and when a device is plugged in or out.

#include <QObject>
#include <QStringList>
#include <QTimer>

#include <functional>
#include <vector>

#include "device/found_devices.h"
#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class DeviceWatch : public QObject {
  Q_OBJECT

 public:
  explicit DeviceWatch(QObject* parent = nullptr);

  /// Starts a search; found() follows.
  void look();

 signals:
  void found(const std::vector<palpate::device::FoundDevice>& devices);

 private:
  struct Seen {
    QStringList plugged;
    bool looked = false;
    std::vector<device::FoundDevice> devices;
  };
  void glance();
  void ask(bool whatever_is_plugged);

  QStringList plugged_;
  int again_ = 0;  // remaining short polls until a second search, because a maker's service finds a device later
  QTimer glances_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
