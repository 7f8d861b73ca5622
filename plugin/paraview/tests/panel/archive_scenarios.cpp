// From an archive to a felt boundary: search, fetch, feel; the files on disk; a newly configured archive, and one that
// never ends. archive_test.py starts the archives.

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDir>
#include <QFileInfo>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QSpinBox>
#include <QTabBar>
#include <QTreeWidget>
#include <QtTest/QTest>

#include <string>

#include "plugin/paraview/tests/panel/busy_watch.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

QTreeWidget& found() {
  return find<QTreeWidget>("palpateFound");
}

void open_archive_tab() {
  auto& tabs = find<QTabBar>("palpateScanTabs");
  click(tabs, tabs.tabRect(1).center());
}

bool is_told(const char* sentence) {
  return label("palpateArchiveMessage") == sentence;
}

/// Types into the field of the patient's name. The field has the keyboard focus, so no press is needed.
void type(const QString& text) {
  auto& field = find<QLineEdit>("palpateFindPatient");
  expect(field.window()->focusWidget() == &field, "the patient's name has the keyboard");
  QTest::keyClicks(&field, text);
}

void choose(QTreeWidgetItem& item) {
  found().scrollToItem(&item);
  click(*found().viewport(), found().visualItemRect(&item).center());
}

/// The first study's first series, once it is listed.
QTreeWidgetItem& first_series() {
  wait_for("series are listed", [] {
    QTreeWidgetItem* const study = found().topLevelItem(0);
    return study && study->isExpanded() && study->childCount() > 0 && study->child(0)->text(0).contains("images");
  });
  return *found().topLevelItem(0)->child(0);
}

QString fetched_folder() {
  return qEnvironmentVariable("HOME") + "/.cache/palpate/fetched";
}

/// Starts with an empty ParaView and counts the presses.
void felt_from_the_archive() {
  open_archive_tab();
  wait_for("the archive's studies are listed", [] { return found().topLevelItemCount() == 2; });
  expect(found().topLevelItem(0)->text(0).startsWith("Mustermann, Max  ·  P2  ·  2026-01-02"), "the latest is first");
  save_screen("archive-found");
  type("Muster^E");
  wait_for("what is typed is looked for", [] { return found().topLevelItemCount() == 1; });
  expect(found().topLevelItem(0)->text(0) == "Muster, Erika  ·  P1  ·  2026-01-01  ·  ball",
         "the study is named: " + found().topLevelItem(0)->text(0).toStdString());
  QTreeWidgetItem& series = first_series();
  expect(series.text(0).endsWith("64 images"), "its images are counted: " + series.text(0).toStdString());
  expect(!find<QPushButton>("palpateFetch").isEnabled(), "nothing is chosen yet");
  choose(series);
  wait_ms(300);  // until the choice is drawn, for the guide's picture
  save_screen("archive-chosen");
  click("palpateFetch");
  scan_is_shown();
  expect(!QFileInfo(fetched_folder()).permission(QFile::ReadGroup | QFile::ExeGroup) &&
             !QFileInfo(fetched_folder()).permission(QFile::ReadOther | QFile::ExeOther),
         "no other user can read what was fetched");
  connect_stylus();
  press();
  expect(clicks() <= 6, "it took at most six presses, not " + std::to_string(clicks()));
  save_screen("archive-felt");
  let_go();
  click("palpateScanSectionFold");
  wait_for("it is said what lies on disk", [] {
    return label("palpateOnDisk").startsWith("On disk: 1 series, ") &&
           is_told("Fetched: 64 images, 0 MiB. They are deleted when the program ends, unless Keep is ticked.");
  });
  wait_for("its line has its picture", [&] { return !series.icon(0).isNull(); });
  const QImage picture = series.icon(0).pixmap(48, 48).toImage();
  expect(qGray(picture.pixel(24, 24)) > qGray(picture.pixel(3, 3)) + 50, "the ball is in its picture's middle");
  click("palpateEmpty");
  wait_ms(1000);
  wait_for("the scan that is open stays", [] { return label("palpateOnDisk").startsWith("On disk: 1 series, "); });
  save_screen("archive-on-disk");

  auto& date = find<QLineEdit>("palpateFindDate");
  date.setText("yesterday");
  QTest::keyClick(&date, Qt::Key_Return);
  wait_for("a date is asked for in the archive's words",
           [] { return is_told("“Date” has to be YYYYMMDD, YYYYMMDD-YYYYMMDD, YYYYMMDD- or -YYYYMMDD"); });
  date.clear();
  QTest::keyClicks(&date, "2025");
  wait_for("a year is a span", [] { return is_told("The archive holds nothing of that kind."); });
  expect(found().topLevelItemCount() == 0, "and nothing is listed");
}

void what_is_fetched_is_kept() {
  open_archive_tab();
  choose(first_series());
  click("palpateKeep");
  click("palpateFetch");
  scan_is_shown();
}

/// A scan does not replace another one that was requested after it.
void what_is_fetched_late_is_offered() {
  open_archive_tab();
  choose(first_series());
  auto& offer = find<QPushButton>("palpateOpenFetched");
  click("palpateFetch");
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  wait_for(
      "it is fetched, and offered", [&] { return !offer.isHidden(); }, 60);
  scan_is_shown();
  connect_stylus();
  const unsigned first = reader_in_pipeline();
  press();
  save_screen("archive-offered");
  expect(number("palpateForce") > 0.1, "the other scan is felt all the while");
  expect(offer.isVisible(), "the offer is not hidden in a section that is closed");
  let_go();
  click("palpateOpenFetched");
  another_scan_is_shown(first);
  expect(offer.isHidden(), "it is open");
}

/// Runs in a new program, after the previous scenario.
void what_was_kept_is_emptied() {
  open_archive_tab();
  wait_for("what was kept is counted", [] { return label("palpateOnDisk").startsWith("On disk: 1 series, "); });
  expect(!find<QCheckBox>("palpateKeep").isChecked(), "it is kept only where one asks for it");
  click("palpateEmpty");
  wait_for("it is gone", [] { return label("palpateOnDisk") == "On disk: 0 series, 0.0 MiB"; });
}

bool dialog_says(const char* sentence) {
  return label("palpateArchiveDialogMessage") == sentence;
}

bool has_answered(const char* message) {
  const QString said = label(message);
  return said.startsWith("clinic answers and knows us as PALPATE (") && said.endsWith(" ms).");
}

void an_archive_is_entered() {
  open_archive_tab();
  wait_for("it is said that there is none", [] {
    return is_told("No archive is entered yet: press Add, and ask the archive's administrator for the five entries.");
  });
  bool entered = false;
  in_dialog("palpateArchiveAdd", [&](QDialog& dialog) {
    click("palpateArchiveOk");
    expect(dialog_says("An archive needs a name."), "a name is asked for");
    find<QLineEdit>("palpateArchiveName").setText("clinic");
    click("palpateArchiveEcho");
    wait_for("what is missing is said",
             [] { return dialog_says("archive clinic: “Host” has to be a machine's name or address"); });
    find<QLineEdit>("palpateArchiveHost").setText("127.0.0.1");
    find<QSpinBox>("palpateArchivePort").setValue(qEnvironmentVariableIntValue("PALPATE_ARCHIVE_PORT"));
    find<QLineEdit>("palpateArchiveCalled").setText("ORTHANC");
    find<QLineEdit>("palpateArchiveCalling").setText("STRANGER");
    click("palpateArchiveEcho");
    wait_for("it does not know us",
             [] { return label("palpateArchiveDialogMessage").contains("does not know us as STRANGER"); });
    expect(label("palpateArchiveDialogMessage").endsWith("or set “Our AE title”"),
           "the field is named, and no option: " + label("palpateArchiveDialogMessage").toStdString());
    handle_events(20);
    const auto& said = find<QLabel>("palpateArchiveDialogMessage");
    expect(said.height() >= said.heightForWidth(said.width()), "all of it is seen");
    save_screen("archive-dialog-refused");
    find<QLineEdit>("palpateArchiveCalling").setText("PALPATE");
    find<QSpinBox>("palpateArchiveListen").setValue(qEnvironmentVariableIntValue("PALPATE_LISTEN_PORT"));
    click("palpateArchiveEcho");
    expect(dialog_says("clinic is asked…"), "it is said that it is asked");
    wait_for("it answers", [] { return has_answered("palpateArchiveDialogMessage"); });
    save_screen("archive-dialog");
    click("palpateArchiveOk");
    entered = !dialog.isVisible();
  });
  expect(entered, "it is entered");
  expect(find<QComboBox>("palpateArchives").currentText() == "clinic", "it is chosen");
  wait_for("it is searched", [] { return found().topLevelItemCount() == 2; });
  click("palpateEcho");
  wait_for("it answers", [] { return has_answered("palpateArchiveMessage"); });
  choose(first_series());
  click("palpateFetch");
  scan_is_shown();
}

/// An archive that accepts only TLS and asks for our certificate.
void an_archive_is_entered_with_tls() {
  const QString certificates = qEnvironmentVariable("PALPATE_CERTIFICATES") + "/";
  open_archive_tab();
  bool entered = false;
  in_dialog("palpateArchiveAdd", [&](QDialog& dialog) {
    find<QLineEdit>("palpateArchiveName").setText("clinic");
    find<QLineEdit>("palpateArchiveHost").setText("127.0.0.1");
    find<QSpinBox>("palpateArchivePort").setValue(qEnvironmentVariableIntValue("PALPATE_ARCHIVE_PORT"));
    find<QLineEdit>("palpateArchiveCalled").setText("ORTHANC");
    find<QLineEdit>("palpateArchiveCalling").setText("PALPATE");
    find<QCheckBox>("palpateArchiveGet").setChecked(true);
    const auto asked = [](const char* what, const char* answer) {
      click("palpateArchiveEcho");
      wait_for(what, [&] { return label("palpateArchiveDialogMessage").contains(answer); });
    };
    asked("without TLS nothing is said to it", "without TLS");
    find<QLineEdit>("palpateArchiveTlsCa").setText(certificates + "authority.pem");
    find<QLineEdit>("palpateArchiveTlsCertificate").setText(certificates + "palpate.pem");
    find<QLineEdit>("palpateArchiveTlsKey").setText(certificates + "archive.key");
    asked("a key of another certificate is refused", "does not belong to");
    find<QLineEdit>("palpateArchiveTlsKey").setText(certificates + "palpate.key");
    find<QLineEdit>("palpateArchiveTlsName").setText("other.example");
    asked("its certificate is for another machine", "is not for other.example");
    find<QLineEdit>("palpateArchiveTlsName").clear();
    click("palpateArchiveEcho");
    wait_for("it answers", [] { return has_answered("palpateArchiveDialogMessage"); });
    save_screen("archive-dialog-tls");
    click("palpateArchiveOk");
    entered = !dialog.isVisible();
  });
  expect(entered, "it is entered");
  choose(first_series());
  click("palpateFetch");
  scan_is_shown();
}

/// Of an archive that sends without end. The user waits for nothing, whatever the archive does.
void a_fetch_is_cancelled() {
  open_archive_tab();
  first_series();
  choose(*found().topLevelItem(0));  // the study, because its series has no UID
  click("palpateFetch");
  auto& progress = find<QProgressBar>("palpateFetching");
  wait_for("it is fetched", [&] { return progress.isVisible(); });
  const auto is_empty = [](const QString& folder) {
    return QDir(folder).entryList(QDir::NoDotAndDotDot | QDir::AllEntries).isEmpty();
  };
  wait_for("something has come", [&] { return !is_empty(fetched_folder() + "/run-001"); });
  save_screen("archive-fetching");
  {
    const BusyWatch watch;
    click("palpateFetchCancel");
    wait_for(
        "it is said", [] { return is_told("Cancelled."); }, 20);
    const auto stretches = watch.without_rendering();
    constexpr double longest_ms = 1000;  // enough for a busy machine; the wait for an archive is much longer
    expect(stretches.empty() || stretches.front() < longest_ms, "nothing waits for the archive");
  }
  wait_for(
      "it can be fetched again", [&] { return !progress.isVisible() && find<QPushButton>("palpateFetch").isEnabled(); },
      20);
  wait_for(
      "nothing is left of it", [&] { return is_empty(fetched_folder() + "/run-001"); }, 20);
}

}  // namespace

const Scenarios& archive_scenarios() {
  static const Scenarios scenarios{
      {"felt_from_the_archive", felt_from_the_archive},
      {"what_is_fetched_is_kept", what_is_fetched_is_kept},
      {"what_is_fetched_late_is_offered", what_is_fetched_late_is_offered},
      {"what_was_kept_is_emptied", what_was_kept_is_emptied},
      {"an_archive_is_entered", an_archive_is_entered},
      {"a_fetch_is_cancelled", a_fetch_is_cancelled},
      {"an_archive_is_entered_with_tls", an_archive_is_entered_with_tls},
  };
  return scenarios;
}
