#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/scan/archive_items.h"
#include "plugin/paraview/client/scan/archive_tab.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words.h"

// What stands in the tab, from top to bottom.

namespace palpate::plugin {

void ArchiveTab::build_archives() {
  auto* const row = new QHBoxLayout;
  archives_ = new QComboBox(this);
  archives_->setObjectName(QStringLiteral("palpateArchives"));
  archives_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  archives_->setToolTip(tr("The archives that were entered here or with `palpate archive add`"));
  connect(archives_, QOverload<int>::of(&QComboBox::activated), this, [this] { search(false); });
  row->addWidget(archives_, 1);
  echo_ = new QPushButton(tr("Echo"), this);
  echo_->setObjectName(QStringLiteral("palpateEcho"));
  echo_->setToolTip(tr("Whether the archive answers and knows us (C-ECHO)"));
  connect(echo_, &QPushButton::clicked, this, [this] { echo(); });
  row->addWidget(echo_);
  auto* const enter = new QPushButton(tr("Add…"), this);
  enter->setObjectName(QStringLiteral("palpateArchiveAdd"));
  enter->setToolTip(tr("Enters an archive, or changes the one of that name"));
  connect(enter, &QPushButton::clicked, this, [this] { enter_archive(); });
  row->addWidget(enter);
  static_cast<QVBoxLayout*>(layout())->addLayout(row);
}

void ArchiveTab::build_search() {
  auto* const grid = new QGridLayout;
  const auto field = [&](const char* name, const QString& what, const QString& tip) {
    auto* const line = new QLineEdit(this);
    line->setObjectName(QString::fromLatin1(name));
    line->setPlaceholderText(what);
    line->setToolTip(tip);
    line->setClearButtonEnabled(true);
    connect(line, &QLineEdit::textEdited, this, [this] { typing_.start(); });
    connect(line, &QLineEdit::returnPressed, this, [this] { search(true); });
    return line;
  };
  grid->addWidget(patient_ = field("palpateFindPatient", tr("Patient"), tr("Part of the name, family name first")), 0,
                  0);
  grid->addWidget(id_ = field("palpateFindId", tr("Patient's id"), tr("The whole id; * stands for anything")), 0, 1, 1,
                  2);
  grid->addWidget(
      description_ = field("palpateFindDescription", tr("Description"), tr("Part of the study's description")), 1, 0);
  grid->addWidget(date_ = field("palpateFindDate", tr("Date"),
                                tr("Of the study: 2026, 2026-01, 2026-01-04, or a span 20260101-20260131")),
                  1, 1);
  modality_ = new QComboBox(this);
  modality_->setObjectName(QStringLiteral("palpateFindModality"));
  modality_->addItem(tr("All"));
  modality_->addItems({QStringLiteral("CT"), QStringLiteral("MR"), QStringLiteral("PT"), QStringLiteral("XA")});
  modality_->setToolTip(tr("Modality"));
  connect(modality_, QOverload<int>::of(&QComboBox::activated), this, [this] { search(false); });
  grid->addWidget(modality_, 1, 2);
  grid->setColumnStretch(0, 3);
  grid->setColumnStretch(1, 3);
  static_cast<QVBoxLayout*>(layout())->addLayout(grid);

  constexpr int picture_pixels = 48;
  found_ = new QTreeWidget(this);
  found_->setObjectName(QStringLiteral("palpateFound"));
  found_->setHeaderHidden(true);
  found_->setColumnCount(1);
  found_->setWordWrap(true);
  found_->setFixedHeight(150);
  found_->setIconSize({picture_pixels, picture_pixels});
  connect(found_, &QTreeWidget::itemClicked, this, [](QTreeWidgetItem* item) { item->setExpanded(true); });
  connect(found_, &QTreeWidget::itemSelectionChanged, this, [this] { set_fetching(fetching_.is_busy()); });
  connect(found_, &QTreeWidget::itemDoubleClicked, this, [this] { fetch(); });
  connect(found_, &QTreeWidget::itemExpanded, this, [this](QTreeWidgetItem* item) {
    if (!is_unlisted(*item)) return;
    unlisted_.push_back(study_of(*item));
    ask_series();
  });
  layout()->addWidget(found_);
}

void ArchiveTab::build_fetch() {
  auto* const work = new QHBoxLayout;
  fetch_ = new QPushButton(tr("Fetch and open"), this);
  fetch_->setObjectName(QStringLiteral("palpateFetch"));
  fetch_->setToolTip(tr("The series that is marked, or the whole study. A double click does the same."));
  connect(fetch_, &QPushButton::clicked, this, [this] { fetch(); });
  work->addWidget(fetch_, 1);
  progress_ = new QProgressBar(this);
  progress_->setObjectName(QStringLiteral("palpateFetching"));
  work->addWidget(progress_, 1);
  cancel_ = new QPushButton(tr("Cancel"), this);
  cancel_->setObjectName(QStringLiteral("palpateFetchCancel"));
  connect(cancel_, &QPushButton::clicked, this, [this] {
    fetching_.cancel();
    set_fetching(false);
    tell(words(say("cancelled")));
  });
  work->addWidget(cancel_);
  static_cast<QVBoxLayout*>(layout())->addLayout(work);

  auto* const disk = new QHBoxLayout;
  keep_ = new QCheckBox(tr("Keep"), this);
  keep_->setObjectName(QStringLiteral("palpateKeep"));
  keep_->setToolTip(tr("Keeps the fetched scans after the program ends. Otherwise they are deleted."));
  connect(keep_, &QCheckBox::toggled, this, [this](bool on) { run_.set_kept(on); });
  disk->addWidget(keep_);
  on_disk_ = new QLabel(this);
  on_disk_->setObjectName(QStringLiteral("palpateOnDisk"));
  disk->addWidget(on_disk_, 1);
  empty_ = new QPushButton(tr("Empty"), this);
  empty_->setObjectName(QStringLiteral("palpateEmpty"));
  empty_->setToolTip(tr("Deletes all that was fetched, but for the scan that is open"));
  connect(empty_, &QPushButton::clicked, this, [this] { empty(); });
  disk->addWidget(empty_);
  static_cast<QVBoxLayout*>(layout())->addLayout(disk);
  message_ = make_message_label(*this, "palpateArchiveMessage");
  layout()->addWidget(message_);
}

}  // namespace palpate::plugin
