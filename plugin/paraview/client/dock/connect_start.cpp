#include <pqCoreUtilities.h>

#include <QMainWindow>
#include <QPointer>

#include <memory>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/layout/empty_center.h"
#include "plugin/paraview/client/layout/host_layout.h"
#include "plugin/paraview/client/layout/start_page.h"
#include "plugin/paraview/client/layout/views_cover.h"
#include "plugin/paraview/client/scan/sample_scan.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"

// Connections of the start page in the center, from which a scan is opened.

namespace palpate::plugin {

void PanelParts::connect_start() {
  auto* const window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  auto* const page = new StartPage(window);
  auto* const center = new EmptyCenter(*window, *page, &dock);
  auto* const cover = new ViewsCover(*window);
  readers.views().set_making_changed([cover = QPointer(cover)](bool making) {
    if (cover) cover->set_shown(making);
  });
  QObject::connect(layout, &HostLayout::advanced_changed, center, &EmptyCenter::set_advanced);
  QObject::connect(page, &StartPage::open_wanted, column->scan, &ScanSection::ask_folder);
  QObject::connect(page, &StartPage::folder_wanted, column->scan,
                   [this](const QString& folder) { column->scan->open(folder.toStdString()); });
  QObject::connect(page, &StartPage::series_wanted, &scans, &ScanModel::choose);
  QObject::connect(page, &StartPage::archive_wanted, column->scan, [this] {
    column->scan_fold->set_open(true);
    column->scan->show_archive();
  });
  QObject::connect(&scans, &ScanModel::listed, &dock, [this, page] {
    const FoundList* const found = scans.found();
    const bool several = found && found->catalogue && !found->catalogue->series.empty() && !found->only();
    page->set_catalogue(several ? found->catalogue : nullptr);
    if (!several) return;
    column->scan_fold->set_open(true);
    if (!scans.seen()) column->scan_fold->set_note({});
  });
  QObject::connect(column->scan, &ScanSection::thumbnail_drawn, page, &StartPage::set_picture);
  QObject::connect(&scans, &ScanModel::told, page, &StartPage::tell);
  // Shows the patient of the coming scan at once, in place of the previous one.
  QObject::connect(&scans, &ScanModel::changed, &dock,
                   [this, page, cover = QPointer(cover), opening = QString()]() mutable {
                     const auto coming = scans.on_its_way();
                     const QString words_now = coming ? tr("Opening %1…").arg(coming->label) : QString();
                     if (cover) cover->set_words(words_now);
                     if (std::exchange(opening, words_now) == words_now) return;
                     if (coming && !scans.seen()) page->tell(words_now);
                     if (coming) {
                       column->scan_fold->set_note(words_now);
                     } else if (scans.shown()) {
                       note_scan(*scans.shown());
                     } else {
                       column->scan_fold->set_note({});
                     }
                   });

  auto* const sample = new SampleScan(&dock);
  page->set_sample(sample->offer());
  const auto requests_before = std::make_shared<unsigned>();
  QObject::connect(page, &StartPage::sample_wanted, sample, [this, page, sample, requests_before] {
    page->tell(words(say("sample-is-written")));
    *requests_before = scans.requests();
    sample->make();
  });
  // A scan that was asked for meanwhile stays; the sample can be asked for again.
  QObject::connect(sample, &SampleScan::ready, column->scan, [this, requests_before](const QString& folder) {
    if (scans.requests() == *requests_before) column->scan->open(folder.toStdString());
  });
  QObject::connect(sample, &SampleScan::failed, page, [page](const QString& why) { page->tell(why, true); });
}

}  // namespace palpate::plugin
