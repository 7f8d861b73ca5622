#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>

#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/scan/archive_items.h"
#include "plugin/paraview/client/scan/archive_search.h"
#include "plugin/paraview/client/scan/archive_tab.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words.h"

// The tab's widgets, from top to bottom.

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
  echo_->setToolTip(tr("Tests whether the archive answers and accepts our AE title (C-ECHO)"));
  connect(echo_, &QPushButton::clicked, this, [this] { echo(); });
  row->addWidget(echo_);
  auto* const enter = new QPushButton(tr("Add…"), this);
  enter->setObjectName(QStringLiteral("palpateArchiveAdd"));
  enter->setToolTip(tr("Adds an archive, or changes the settings of the archive with that name"));
  connect(enter, &QPushButton::clicked, this, [this] { enter_archive(); });
  row->addWidget(enter);
  static_cast<QVBoxLayout*>(layout())->addLayout(row);
}

void ArchiveTab::build_search() {
  search_ = new ArchiveSearch(this);
  connect(search_, &ArchiveSearch::wanted, this, &ArchiveTab::search);
  layout()->addWidget(search_);

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
  fetch_->setToolTip(tr("Fetches the selected series, or the whole study. A double click does the same."));
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
  offer_ = new QPushButton(tr("Open what was fetched"), this);
  offer_->setObjectName(QStringLiteral("palpateOpenFetched"));
  offer_->setToolTip(
      tr("It was fetched, but it is not open: you chose another scan meanwhile, or kept the one before."));
  offer_->hide();
  connect(offer_, &QPushButton::clicked, this, [this] {
    emit offer_taken(std::exchange(offered_, {}));
    offer_->hide();
  });
  layout()->addWidget(offer_);

  auto* const disk = new QHBoxLayout;
  auto* const keep = new QCheckBox(tr("Keep"), this);
  keep->setObjectName(QStringLiteral("palpateKeep"));
  keep->setToolTip(tr("Keeps the fetched scans after the program ends. Otherwise they are deleted."));
  connect(keep, &QCheckBox::toggled, this, [this](bool on) { run_.set_kept(on); });
  disk->addWidget(keep);
  on_disk_ = new QLabel(this);
  on_disk_->setObjectName(QStringLiteral("palpateOnDisk"));
  disk->addWidget(on_disk_, 1);
  empty_ = new QPushButton(tr("Empty"), this);
  empty_->setObjectName(QStringLiteral("palpateEmpty"));
  empty_->setToolTip(tr("Deletes all fetched scans except the open one"));
  connect(empty_, &QPushButton::clicked, this, [this] { empty(); });
  disk->addWidget(empty_);
  static_cast<QVBoxLayout*>(layout())->addLayout(disk);
  message_ = make_message_label(*this, "palpateArchiveMessage");
  layout()->addWidget(message_);
}

}  // namespace palpate::plugin
