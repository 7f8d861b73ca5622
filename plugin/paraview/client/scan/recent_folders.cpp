#include "plugin/paraview/client/scan/recent_folders.h"

#include <QDir>
#include <QFileInfo>
#include <QSettings>

namespace palpate::plugin {
namespace {

constexpr int most = 8;

QString key() {
  return QStringLiteral("palpate/folders");
}

}  // namespace

QStringList recent_folders() {
  QStringList folders;
  for (const QString& folder : QSettings().value(key()).toStringList()) {
    if (QFileInfo::exists(folder)) folders << folder;
  }
  return folders;
}

void remember_folder(const QString& folder) {
  const QString path = QFileInfo(folder).absoluteFilePath();
  QStringList folders = QSettings().value(key()).toStringList();
  folders.removeAll(path);
  folders.prepend(path);
  QSettings().setValue(key(), QStringList(folders.mid(0, most)));
}

QString last_place() {
  const QStringList folders = recent_folders();
  return folders.isEmpty() ? QString() : QFileInfo(folders.first()).dir().absolutePath();
}

}  // namespace palpate::plugin
