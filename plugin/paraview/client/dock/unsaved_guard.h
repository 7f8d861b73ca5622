#pragma once

/// Asks about unsaved work before it is lost, or saves it where the user cannot be asked.

#include <QObject>
#include <QString>

#include <functional>

#include "plugin/paraview/client/model/scan_model.h"
#include "plugin/paraview/client/model/unsaved_work.h"

class QMainWindow;

namespace palpate::plugin {

class UnsavedGuard : public QObject {
  Q_OBJECT

 public:
  UnsavedGuard(UnsavedWork& work, ScanModel& scans, QMainWindow& window);

  /// Called if ParaView's session ends without a question: by a script or another server. Saves the work, and returns
  /// a message about it; empty: there was nothing to save.
  QString recover();

 private:
  bool may_lose(const Unsaved& work, const QString& before, const std::function<void()>& let_go);
  bool save_state();
  bool write_state(const QString& file);
  static QString not_written(const QString& file);

  UnsavedWork& work_;
  QMainWindow& window_;
  bool saving_ = false;  // a state file is being saved; this may fail
  bool ending_ = false;  // the program ends, and the user has been asked
};

}  // namespace palpate::plugin
