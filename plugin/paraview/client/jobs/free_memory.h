#pragma once

/// Memory that is free again once a scan has gone. The C library keeps it, spread over what the program still holds: a
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

  /// Gives it back to the system, in the background, once nothing more was asked for 2 s.
  void give_back_soon() { soon_.start(); }

 private:
  static constexpr int wait_ms = 2000;
  QTimer soon_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
