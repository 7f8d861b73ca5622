#pragma once

/// Folders from which scans were opened, the newest first; kept for the next start of the program.

#include <QString>
#include <QStringList>

namespace palpate::plugin {

/// Those that still exist.
QStringList recent_folders();
void remember_folder(const QString& folder);
/// The initial place of a dialog for a folder: beside the latest folder; empty if there is none.
QString last_place();

}  // namespace palpate::plugin
