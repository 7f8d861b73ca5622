// From an empty ParaView to a scan, and from there to a force. choosing_test.py names the folders.

#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqTabbedMultiViewWidget.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>

#include <QCoreApplication>
#include <QDir>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QGuiApplication>
#include <QLabel>
#include <QListWidget>
#include <QMainWindow>
#include <QMimeData>
#include <QPixmap>
#include <QPushButton>
#include <QScreen>
#include <QScrollArea>
#include <QUrl>

#include <filesystem>
#include <string>
#include <vector>

#include "plugin/app/archive_settings.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

QMainWindow& window() {
  return *qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
}

QScrollArea& page() {
  return find<QScrollArea>("palpateStart");
}

bool views_are_there() {
  return window().findChild<pqTabbedMultiViewWidget*>()->isVisible();
}

void expect_page(bool there, const std::string& when) {
  wait_for(
      "the start page is " + std::string(there ? "there " : "gone ") + when,
      [there] { return page().isVisible() == there && views_are_there() != there; }, 20);
}

void drop_on_page(const QString& folder) {
  QWidget& on = *page().viewport();
  QMimeData folders;
  folders.setUrls({QUrl::fromLocalFile(folder)});
  QDragEnterEvent enter(on.rect().center(), Qt::CopyAction, &folders, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&on, &enter);
  expect(enter.isAccepted(), "a folder may be dropped");
  QDropEvent drop(on.rect().center(), Qt::CopyAction, &folders, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(&on, &drop);
}

std::vector<QPushButton*> cards() {
  std::vector<QPushButton*> all;
  for (auto* const one : page().findChildren<QPushButton*>(QStringLiteral("palpateCard"))) all.push_back(one);
  return all;
}

/// All that can be read on the page, line by line.
QStringList lines_on_page() {
  QStringList lines;
  for (const auto* const one : page().findChildren<QLabel*>()) {
    if (one->isVisible()) lines << one->text().split('\n');
  }
  return lines;
}

QStringList texts_of(const char* name) {
  QStringList texts;
  for (const auto* const one : page().findChildren<QLabel*>(QString::fromLatin1(name))) texts << one->text();
  return texts;
}

bool says(const QPushButton& card, const char* words) {
  return card.accessibleName().contains(QLatin1String(words));
}

QPushButton& best_card() {
  for (auto* const card : cards()) {
    for (const auto* const line : card->findChildren<QLabel*>()) {
      if (line->text().startsWith(QStringLiteral("★ Recommended: "))) return *card;
    }
  }
  throw std::runtime_error("no card is recommended");
}

void click_card(QPushButton& card) {
  page().ensureWidgetVisible(&card);
  is_laid_out(card);
  click(card, card.rect().center());
}

/// A folder with several patients' series, some of which are no volumes; then another patient's.
void a_scan_is_chosen_in_the_center() {
  window().setGeometry(QGuiApplication::primaryScreen()->geometry());
  expect_page(true, "at first");
  for (const char* const button : {"palpateStartOpen", "palpateStartArchive", "palpateStartSample"}) {
    expect(find<QPushButton>(button).isVisible(), std::string(button) + " is there");
  }
  expect(lines_on_page().contains("Drop a DICOM folder here"), "it is said where to drop a folder");
  save_screen("start-page");
  drop_on_page(qEnvironmentVariable("PALPATE_DROP"));
  wait_for("cards are listed", [] { return cards().size() > 3; });
  expect_page(true, "while one chooses");
  wait_for("a series that can be felt has its picture", [] {
    const auto* const picture = best_card().findChild<QLabel*>();
    return picture->width() == 128 && picture->height() == 128 && !picture->pixmap(Qt::ReturnByValue).isNull();
  });
  int closed = 0, open = 0;
  for (auto* const card : cards()) {
    (card->isEnabled() ? open : closed) += 1;
    expect(card->isEnabled() || card->toolTip().size() > 5, "it is said why a series cannot be felt");
  }
  expect(open == 3 && closed == 4, "three series can be felt, four not");
  QPushButton& best = best_card();
  expect(says(best, "201  STD BRAIN 5MM") && says(best, "2015-02-06 09:29") && says(best, "kernel UB") &&
             says(best, "5 mm thick, every 5 mm") && says(best, "28 slices"),
         "the best is told from the others: " + best.accessibleName().toStdString());
  auto& list = find<QListWidget>("palpateSeries");
  int marked = 0;
  for (int row = 0; row < list.count(); ++row) {
    if (!list.item(row)->text().contains("★ Recommended: slices every 5.00 mm")) continue;
    ++marked;
    expect(list.item(row)->text().startsWith("CT STD BRAIN 5MM, 128 x 128 x 28\n201"), "the panel marks the same one");
  }
  expect(marked == 1, "one is the best");
  wait_ms(1500);
  save_screen("start-cards");
  click_card(best);
  expect_page(false, "where a scan is shown");
  scan_is_shown();
  save_screen("start-chosen");

  // The same patient's folder leaves the scan where it is; another patient's takes it away before its names are read.
  drop_folder(qEnvironmentVariable("PALPATE_OTHER"));
  wait_for("another patient's series are listed", [] { return cards().size() == 2; });
  expect_page(true, "where another patient's series are listed");
  expect(reader_in_pipeline() == 0, "nothing of the last patient is in the pipeline");
  expect(texts_of("palpateStartPatient") == QStringList("Muster, Erika   ID P1"), "one patient's name is on the page");
  expect(texts_of("palpateStartStudy") == QStringList("Study of 2026-01-01"), "and one study");
  expect(!find<QPushButton>("palpateConnect").isEnabled(), "there is nothing to feel");
  save_screen("start-other-patient");
  click_card(*cards().back());
  scan_is_shown();
  drop_folder(qEnvironmentVariable("PALPATE_OTHER"));
  wait_for("they are listed again", [] { return find<QListWidget>("palpateSeries").count() == 2; });
  wait_ms(1000);
  expect(reader_in_pipeline() != 0 && views_are_there(), "the same patient's scan stays while one chooses again");
}

/// Folders that were opened before, by one press; and where the dialog begins.
void folders_are_opened_again() {
  expect_page(true, "at first");
  drop_on_page(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  QString began;
  click("palpateScanSectionFold");
  in_dialog("palpateOpen", [&](QDialog& dialog) {
    auto* const asks = qobject_cast<QFileDialog*>(&dialog);
    expect(asks != nullptr, "a folder is asked for");
    began = asks->directory().absolutePath();
    dialog.reject();
  });
  expect(began == QFileInfo(qEnvironmentVariable("PALPATE_DROP")).dir().absolutePath(),
         "the dialog begins where one was last: " + began.toStdString());
}

/// In a program of its own, after the one before.
void a_recent_folder_is_pressed() {
  expect_page(true, "at first");
  auto& folder = find<QPushButton>("palpateStartFolder");
  expect(folder.text() == qEnvironmentVariable("PALPATE_DROP"), "the folder is listed");
  save_screen("start-recent");
  click("palpateStartFolder");
  scan_is_shown();
}

void a_sample_is_tried() {
  expect_page(true, "at first");
  auto& sample = find<QPushButton>("palpateStartSample");
  expect(sample.isVisible(), "a sample is offered");
  expect(sample.text() == (qEnvironmentVariableIsSet("PALPATE_HEAD") ? "Try the sample head" : "Try a phantom"),
         "as what it is: " + sample.text().toStdString());
  click("palpateStartSample");
  expect(label("palpateStartMessage") == "The sample scan is being written…", "it is said what takes its time");
  wait_for(
      "it is in the pipeline", [] { return reader_in_pipeline() != 0; }, 180);
  scan_is_shown();
  save_screen("start-sample");
}

/// A folder that is dropped while the sample is written: its scan stays.
void a_sample_comes_too_late() {
  const QString folder = qEnvironmentVariable("PALPATE_DROP");
  click("palpateStartSample");
  drop_folder(folder);
  const auto is_the_folders = [&folder] {
    return reader_in_pipeline() != 0 &&
           QString(vtkSMPropertyHelper(reader().getProxy(), "FileName").GetAsString()).startsWith(folder);
  };
  wait_for("the folder's scan is in the pipeline", is_the_folders);
  const auto sample = palpate::plugin::user_folder("XDG_CACHE_HOME", ".cache") /
                      (qEnvironmentVariableIsSet("PALPATE_HEAD") ? "sample-head" : "sample-phantom");
  wait_for(
      "the sample is written", [&sample] { return std::filesystem::exists(sample); }, 180);
  wait_ms(2000);
  scan_is_shown();
  expect(is_the_folders(), "the sample does not take its place");
}

void a_sample_cannot_be_written() {
  click("palpateStartSample");
  wait_for("it is said",
           [] { return label("palpateStartMessage").startsWith("The sample scan cannot be written to "); });
}

/// Each press counted, from an empty ParaView to a force. A folder is named in the dialog: that is one press more.
void felt_in_six_presses() {
  expect_page(true, "at first");
  constexpr int named = 1;
  name_file("palpateStartOpen", qEnvironmentVariable("PALPATE_CHOOSE"));
  wait_for(
      "it is opened, or to be chosen from", [] { return reader_in_pipeline() != 0 || !cards().empty(); }, 120);
  if (reader_in_pipeline() == 0) click_card(best_card());
  scan_is_shown();
  connect_stylus();
  press();
  const int presses = clicks() + named;
  expect(presses <= 6, "it took at most six presses, not " + std::to_string(presses));
  save_screen(("felt-" + qEnvironmentVariable("PALPATE_WHAT")).toStdString());
}

}  // namespace

const Scenarios& choosing_scenarios() {
  static const Scenarios scenarios{
      {"a_scan_is_chosen_in_the_center", a_scan_is_chosen_in_the_center},
      {"folders_are_opened_again", folders_are_opened_again},
      {"a_recent_folder_is_pressed", a_recent_folder_is_pressed},
      {"a_sample_is_tried", a_sample_is_tried},
      {"a_sample_comes_too_late", a_sample_comes_too_late},
      {"a_sample_cannot_be_written", a_sample_cannot_be_written},
      {"felt_in_six_presses", felt_in_six_presses},
  };
  return scenarios;
}
