#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>

#include <QDateTime>
#include <QDir>
#include <QFile>
#include <QMainWindow>
#include <QStandardPaths>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/layout/host_guards.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/panel/unsaved_question.h"
#include "plugin/paraview/client/widgets/file_name.h"
#include "plugin/paraview/client/words.h"

// What is not saved is asked about before it goes, or kept where that cannot be asked.

namespace palpate::plugin {
namespace {

QString now_in_a_name() {
  return QDateTime::currentDateTime().toString(QStringLiteral("yyyyMMdd-HHmmss"));
}

}  // namespace

void PanelParts::connect_unsaved() {
  QObject::connect(tissues, &TissuesSection::scene_kept, &dock, [this] { unsaved.note_scene_saved(); });
  QObject::connect(pqApplicationCore::instance(), &pqApplicationCore::stateSaved, &dock, [this] {
    if (!saving) unsaved.note_state_saved();
  });
  scans.set_may_leave([this] {
    return may_lose(unsaved.of_scan(), tr("Another scan takes the place of this one."),
                    [this] { unsaved.let_scene_go(); });
  });
  auto* const window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  new HostGuards(
      *window,
      [this] {
        return may_lose(unsaved.of_program(), tr("ParaView is about to end."), [this] { unsaved.let_all_go(); });
      },
      [this] {
        return may_lose(unsaved.of_program(), tr("All that is open is about to go."), [this] { unsaved.let_all_go(); });
      },
      &dock);
}

/// Whether the user wants what follows: where something is not saved they are asked.
bool PanelParts::may_lose(const Unsaved& work, const QString& before, const std::function<void()>& let_go) {
  if (!work.any()) return true;
  switch (ask_what_becomes_of(work, before, pqCoreUtilities::mainWidget())) {
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

bool PanelParts::save_state() {
  const QString file =
      ask_file_to_write(pqCoreUtilities::mainWidget(), tr("Save all that is open"), tr("ParaView states (*.pvsm)"),
                        QStringLiteral("pvsm"), QStringLiteral("palpate-%1.pvsm").arg(now_in_a_name()));
  return !file.isEmpty() && write_state(file);
}

bool PanelParts::write_state(const QString& file) {
  saving = true;
  const bool written = pqApplicationCore::instance()->saveState(file);
  saving = false;
  if (written) {
    unsaved.note_state_saved();
  } else {
    emit touching.told(
        words(say("panel-cannot-write", file.toStdString(), tr("no such folder, or no right to it").toStdString())),
        true);
  }
  return written;
}

/// ParaView's session ends, and nobody was asked: by a script, or by another server. What is to be told of it.
QString PanelParts::recover() {
  if (!unsaved.of_program().any()) return {};
  const QString work = in_words(unsaved.of_program());
  const QDir folder(QStandardPaths::writableLocation(QStandardPaths::GenericDataLocation) + QStringLiteral("/palpate"));
  folder.mkpath(QStringLiteral("."));
  const QString file = folder.filePath(QStringLiteral("unsaved-%1.pvsm").arg(now_in_a_name()));
  if (!write_state(file)) return {};
  QFile::setPermissions(file, QFileDevice::ReadOwner | QFileDevice::WriteOwner);  // it names the patient's folder
  return words(say("unsaved-work-is-kept", work.toStdString(), file.toStdString()));
}

}  // namespace palpate::plugin
