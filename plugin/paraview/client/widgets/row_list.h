#pragma once

#include <QHeaderView>
#include <QTreeWidget>

namespace palpate::plugin {

/// A list of rows with two columns and no header: one column is as wide as its texts, the other takes the rest.
inline QTreeWidget* make_row_list(QWidget& parent, const char* name, int wide_column, int height) {
  auto* const list = new QTreeWidget(&parent);
  list->setObjectName(QString::fromLatin1(name));
  list->setHeaderHidden(true);
  list->setRootIsDecorated(false);
  list->setUniformRowHeights(true);
  list->setColumnCount(2);
  list->header()->setStretchLastSection(false);
  list->header()->setSectionResizeMode(wide_column, QHeaderView::Stretch);
  list->header()->setSectionResizeMode(1 - wide_column, QHeaderView::ResizeToContents);
  list->setFixedHeight(height);
  return list;
}

}  // namespace palpate::plugin
