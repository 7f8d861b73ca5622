#pragma once

/// The lines of what an archive holds: studies, and below them their series.

#include <QHash>
#include <QIcon>
#include <QString>

#include <vector>

#include "io/archive/find.h"

class QTreeWidget;
class QTreeWidgetItem;

namespace palpate::plugin {

/// A study, with a line that stands for its series until they are known.
void add_study(QTreeWidget& tree, const io::ArchivedStudy& study);
void add_series(QTreeWidgetItem& study, const std::vector<io::ArchivedSeries>& series);
/// Pictures, by the UID of their series, for the lines that have one.
void show_pictures(QTreeWidget& tree, const QHash<QString, QIcon>& pictures);

/// Of a line's study, also where it is a series; empty where it is neither.
QString study_of(const QTreeWidgetItem& item);
/// Of what is fetched where the line is chosen: a series or a study. Empty where it is neither.
QString uid_of(const QTreeWidgetItem& item);
/// Whether a study's series are not known yet.
bool is_unlisted(const QTreeWidgetItem& item);

}  // namespace palpate::plugin
