#pragma once

/// Folders that scans were opened from, the newest first; remembered from one start of the program to the next.

#include <QString>
#include <QStringList>

namespace palpate::plugin {

/// Those that are still there.
QStringList recent_folders();
void remember_folder(const QString& folder);
/// Where a dialog for a folder begins: beside the one that was last opened; empty if there is none.
QString last_place();

}  // namespace palpate::plugin
