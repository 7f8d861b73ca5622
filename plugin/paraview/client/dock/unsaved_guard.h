#pragma once

/// What is not saved is asked about before it goes, or kept where that cannot be asked.

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

  /// ParaView's session ends, and nobody was asked: by a script, or by another server. What is to be told of it; empty:
  /// there was nothing to be kept.
  QString recover();

 private:
  bool may_lose(const Unsaved& work, const QString& before, const std::function<void()>& let_go);
  bool save_state();
  bool write_state(const QString& file);
  static QString not_written(const QString& file);

  UnsavedWork& work_;
  QMainWindow& window_;
  bool saving_ = false;  // a state file, which may fail
  bool ending_ = false;  // the program, which has asked
};

}  // namespace palpate::plugin
