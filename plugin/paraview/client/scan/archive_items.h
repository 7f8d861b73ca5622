#pragma once

/// The lines of an archive's contents: studies, and below them their series.

#include <QHash>
#include <QIcon>
#include <QString>

#include <vector>

#include "io/archive/find.h"

class QTreeWidget;
class QTreeWidgetItem;

namespace palpate::plugin {

/// A study. Below it one line says that its series are being asked for; add_series() replaces that line.
void add_study(QTreeWidget& tree, const io::ArchivedStudy& study);
void add_series(QTreeWidgetItem& study, const std::vector<io::ArchivedSeries>& series);
/// Shows pictures for the lines of these series (by UID).
void show_pictures(QTreeWidget& tree, const QHash<QString, QIcon>& pictures);

/// The study UID of a line, which may be a study or a series; empty for other lines.
QString study_of(const QTreeWidgetItem& item);
/// The UID that is fetched when the line is chosen: a series' or a study's. Empty for other lines.
QString uid_of(const QTreeWidgetItem& item);
/// Whether the series of a study are not yet known.
bool is_unlisted(const QTreeWidgetItem& item);

}  // namespace palpate::plugin
