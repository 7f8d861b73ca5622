// Sending marks to an archive, and the dialog that first shows what will be sent.

#include <QComboBox>
#include <QDialog>
#include <QFile>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QRegularExpression>

#include <string>

#include "plugin/paraview/tests/panel/mark_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"
#include "plugin/report/marks_text.h"

namespace {

using namespace palpate;

/// On a scan that lies in the archive, too; archive_test.py looks what has come there.
void marks_are_sent() {
  scan_is_shown();
  connect_stylus();
  mark_three();
  choose_marks({0, 1});
  click("palpateKeepMeasure");
  has_rows(4, "a distance is kept");
  in_dialog("palpateSendMarks", [](QDialog& dialog) {
    expect(label("palpateSendPatient") == "Muster, Erika  ·  P1",
           "for whom: " + label("palpateSendPatient").toStdString());
    expect(label("palpateSendStudy").startsWith("2026-01-01"), "of which day");
    expect(label("palpateSendWhat") == "A report (SR) of 3 marks, 1 distances and 0 paths, and 3 pictures of the marks",
           "what: " + label("palpateSendWhat").toStdString());
    expect(label("palpateSendNote").contains("research software"), "that it is research software");
    expect(find<QComboBox>("palpateSendArchive").currentText().startsWith("clinic (127.0.0.1:"), "to where");
    save_screen("marks-send");
    dialog.reject();
  });
  wait_ms(300);
  expect(label("palpateMarkMessage").isEmpty() && !find<QWidget>("palpateSending").isVisible(),
         "what is only looked at is not sent");
  in_dialog("palpateSendMarks", [](QDialog&) { click("palpateSendOk"); });
  wait_for("they are sent", [] { return label("palpateMarkMessage") == "Sent to clinic: a report and 3 pictures."; });
  QFile file(beside_pictures("sent-marks.json"));
  expect(file.open(QIODevice::WriteOnly), "what was sent can be told");
  file.write(plugin::marks_as_json(kept_marks(), "HU").c_str());
}

/// To an archive that is not there.
void marks_are_not_sent() {
  scan_is_shown();
  expect(!find<QPushButton>("palpateSendMarks").isEnabled(), "there is nothing to send");
  connect_stylus();
  mark_three();
  in_dialog("palpateSendMarks", [](QDialog&) { click("palpateSendOk"); });
  wait_for("it is said why not", [] {
    return label("palpateMarkMessage").contains("clinic (127.0.0.1:1) cannot be reached (connection refused)");
  });
  expect(find<QPushButton>("palpateSendMarks").isEnabled(), "it can be tried again");
  // What was said of this patient's marks does not stay beside the next one's name.
  const unsigned before = reader_in_pipeline();
  drop_folder(qEnvironmentVariable("PALPATE_OTHER"));  // the marks wait for their scan
  another_scan_is_shown(before);
  expect(label("palpateMarkMessage").isEmpty(), "of another's marks nothing is said");
  has_rows(0, "the other patient has no marks");
  const std::string kept = marks_text();
  click("palpateUndoMark");
  wait_ms(500);
  expect(mark_list().topLevelItemCount() == 0 && marks_text() == kept, "and no step of the patient before is undone");
}

/// In free space, where nothing is held: a key that is tapped while the hand moves, and one that is kept down.
void marks_without_contact_are_called_that() {
  scan_is_shown();
  connect_stylus();
  QWidget& coronal = view("Coronal");
  step("Next", 8);
  press_key_in(coronal, "m");
  step_hand(coronal, "Left");
  has_rows(1, "a key that is tapped makes a mark");
  expect(number("palpateForce") == 0, "nothing is felt there");
  expect(kept_marks().paths.empty() && kept_marks().points.size() == 1, "and no path");
  hold_key_in(coronal, "m", true);
  step("Left", 8);
  hold_key_in(coronal, "m", false);
  has_rows(2, "one that is kept down makes a path");
  in_dialog("palpateSendMarks", [](QDialog& dialog) {
    const QString report = find<QPlainTextEdit>("palpateSendReport").toPlainText().replace('\n', '|');
    const QRegularExpression all(
        "^Mark 1: [LR] [^|]*, no boundary felt, value [^|]* HU, 0.00 N\\|Path 1, without contact: [0-9.]+ mm\\|$");
    expect(all.match(report).hasMatch(), "before it is sent, the report says that: " + report.toStdString());
    save_screen("marks-without-contact");
    dialog.reject();
  });
}

}  // namespace

const Scenarios& sent_mark_scenarios() {
  static const Scenarios scenarios{
      {"marks_are_sent", marks_are_sent},
      {"marks_are_not_sent", marks_are_not_sent},
      {"marks_without_contact_are_called_that", marks_without_contact_are_called_that},
  };
  return scenarios;
}
