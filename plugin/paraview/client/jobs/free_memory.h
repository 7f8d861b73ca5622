#pragma once

/// Returns memory to the system after a scan was closed. The C library would keep it, scattered among used memory: a
/// few hundred megabytes after a few scans.

#include <malloc.h>

#include <QTimer>

#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

class FreeMemory {
 public:
  FreeMemory() {
    soon_.setSingleShot(true);
    soon_.setInterval(wait_ms);
    QObject::connect(&soon_, &QTimer::timeout, &soon_, [this] {
      job_.ask([] { return malloc_trim(0); }, [](const auto& /*given*/, const QString& /*error*/) {});
    });
  }

  /// Returns it in the background, 2 s after the last call.
  void give_back_soon() { soon_.start(); }

 private:
  static constexpr int wait_ms = 2000;
  QTimer soon_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
