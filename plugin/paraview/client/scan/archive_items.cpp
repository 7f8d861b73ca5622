#include "plugin/paraview/client/scan/archive_items.h"

#include <QCoreApplication>
#include <QList>
#include <QStringList>
#include <QTreeWidget>
#include <QTreeWidgetItemIterator>

#include <algorithm>
#include <span>

#include "plugin/paraview/client/words/patient_words.h"

namespace palpate::plugin {
namespace {

constexpr int uid_role = Qt::UserRole;
constexpr std::size_t most_series_shown = 1000;  // more are not looked through

QString translated(const char* text) {
  return QCoreApplication::translate("ArchiveTab", text);
}

QString joined(QStringList parts) {
  parts.removeAll(QString());
  return parts.join(QStringLiteral("  ·  "));
}

}  // namespace

void add_study(QTreeWidget& tree, const io::ArchivedStudy& study) {
  auto* const item = new QTreeWidgetItem(&tree);
  item->setData(0, uid_role, QString::fromStdString(study.uid));
  item->setText(0, joined({patient_in_words(study.patient), QString::fromStdString(study.patient_id),
                           date_in_words(study.date), QString::fromStdString(study.description)}));
  item->setToolTip(0, item->text(0));
  item->setChildIndicatorPolicy(QTreeWidgetItem::ShowIndicator);
  auto* const to_come = new QTreeWidgetItem(item);
  to_come->setText(0, translated("Its series are asked for…"));
  to_come->setFlags(Qt::ItemIsEnabled);
}

void add_series(QTreeWidgetItem& study, const std::vector<io::ArchivedSeries>& series) {
  qDeleteAll(study.takeChildren());
  const std::size_t shown = std::min(series.size(), most_series_shown);
  QList<QTreeWidgetItem*> items;
  items.reserve(static_cast<int>(shown) + 1);
  for (const io::ArchivedSeries& one : std::span(series).first(shown)) {
    auto* const item = new QTreeWidgetItem;
    items << item;
    item->setData(0, uid_role, QString::fromStdString(one.uid));
    const QString images = one.images < 0 ? QString() : translated("%1 images").arg(one.images);
    item->setText(0, joined({QString::number(one.number), QString::fromStdString(one.modality),
                             QString::fromStdString(one.description), images}));
    item->setToolTip(0, item->text(0));
  }
  if (series.size() > shown) {
    auto* const more = new QTreeWidgetItem;
    more->setText(0, translated("… and %1 more series: fetch the whole study for them").arg(series.size() - shown));
    more->setFlags(Qt::ItemIsEnabled);
    items << more;
  }
  study.addChildren(items);  // at once: the tree lays itself out anew after each
}

void show_pictures(QTreeWidget& tree, const QHash<QString, QIcon>& pictures) {
  if (pictures.isEmpty()) return;
  for (QTreeWidgetItemIterator line(&tree); *line; ++line) {
    const auto picture = pictures.find(uid_of(**line));
    if (picture != pictures.end()) (*line)->setIcon(0, *picture);
  }
}

QString study_of(const QTreeWidgetItem& item) {
  return (item.parent() ? *item.parent() : item).data(0, uid_role).toString();
}

QString uid_of(const QTreeWidgetItem& item) {
  return item.data(0, uid_role).toString();
}

bool is_unlisted(const QTreeWidgetItem& item) {
  return !item.parent() && item.childCount() == 1 && uid_of(*item.child(0)).isEmpty();
}

}  // namespace palpate::plugin
