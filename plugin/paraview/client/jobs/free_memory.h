#pragma once

/// Memory that is free again once a scan has gone. The C library keeps it, spread over what the program still holds: a
/// few hundred megabytes after a few scans.

#include <malloc.h>

#include <QThreadPool>
#include <QTimer>

namespace palpate::plugin {

class FreeMemory {
 public:
  FreeMemory() {
    pool_.setMaxThreadCount(1);
    soon_.setSingleShot(true);
    soon_.setInterval(wait_ms);
    QObject::connect(&soon_, &QTimer::timeout, &soon_, [this] { pool_.start([] { malloc_trim(0); }); });
  }

  /// Gives it back to the system, in the background, once nothing more was asked for 2 s.
  void give_back_soon() { soon_.start(); }

 private:
  static constexpr int wait_ms = 2000;
  QTimer soon_;
  QThreadPool pool_;
};

}  // namespace palpate::plugin
