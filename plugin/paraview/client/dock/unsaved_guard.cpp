#include "plugin/paraview/client/dock/unsaved_guard.h"

#include <pqApplicationCore.h>
#include <vtkPVXMLElement.h>

#include <QCoreApplication>
#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QMainWindow>
#include <QStandardPaths>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/layout/host_guards.h"
#include "plugin/paraview/client/panel/unsaved_question.h"
#include "plugin/paraview/client/widgets/file_name.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

QString now_in_a_name() {
  return QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-HHmmss"));
}

}  // namespace

UnsavedGuard::UnsavedGuard(UnsavedWork& work, ScanModel& scans, QMainWindow& window) : work_(work), window_(window) {
  auto* const application = pqApplicationCore::instance();
  connect(application, &pqApplicationCore::stateSaved, this, [this] {
    if (!saving_) work_.note_state_saved();
  });
  connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, this, [this] { ending_ = true; });
  scans.set_may_leave([this] {
    return may_lose(work_.of_scan(), tr("Another scan is about to replace this one."),
                    [this] { work_.let_scene_go(); });
  });
  connect(&scans, &ScanModel::not_coming, this, [this] { work_.keep_scene(); });
  new HostGuards(
      window,
      [this] { return may_lose(work_.of_program(), tr("ParaView is about to end."), [this] { work_.let_all_go(); }); },
      [this] {
        return may_lose(work_.of_program(), tr("This closes everything that is open."), [this] { work_.let_all_go(); });
      },
      [this] { work_.keep_all(); }, this);
}

/// Asks the user if something is not saved. Returns whether the action may go on.
bool UnsavedGuard::may_lose(const Unsaved& work, const QString& before, const std::function<void()>& let_go) {
  if (!work.any()) return true;
  switch (ask_what_becomes_of(work, before, &window_)) {
    case UnsavedAnswer::save:
      return save_state();
    case UnsavedAnswer::discard:
      let_go();
      return true;
    case UnsavedAnswer::cancel:
      break;
  }
  return false;
}

QString UnsavedGuard::not_written(const QString& file) {
  return words(say("panel-cannot-write", file.toStdString(),
                   tr("the folder does not exist, or you may not write to it").toStdString()));
}

bool UnsavedGuard::save_state() {
  const QString file =
      ask_file_to_write(&window_, tr("Save all that is open"), tr("ParaView states (*.pvsm)"), QStringLiteral("pvsm"),
                        QStringLiteral("palpate-%1.pvsm").arg(now_in_a_name()));
  if (file.isEmpty()) return false;
  const bool written = write_state(file);
  if (!written) tell_not_written(&window_, tr("Save all that is open"), not_written(file));
  return written;
}

bool UnsavedGuard::write_state(const QString& file) {
  saving_ = true;
  const bool written = pqApplicationCore::instance()->saveState(file);
  saving_ = false;
  if (written) work_.note_state_saved();
  return written;
}

QString UnsavedGuard::recover() {
  if (ending_ || !work_.of_program().any()) return {};
  const QString work = in_words(work_.of_program());
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) + QStringLiteral("/palpate"));
  folder.mkpath(QStringLiteral("."));
  const QString file = folder.filePath(QStringLiteral("unsaved-%1.pvsm").arg(now_in_a_name()));
  if (!write_state(file)) return not_written(file);
  QFile::setPermissions(file, QFileDevice::ReadOwner | QFileDevice::WriteOwner);  // the file names the patient's folder
  return words(say("unsaved-work-is-kept", work.toStdString(), file.toStdString()));
}

}  // namespace palpate::plugin
