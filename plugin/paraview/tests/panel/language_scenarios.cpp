// The panel in German: started with LC_ALL=de_DE.UTF-8, compared with texts by a native speaker.

#include <pqCoreUtilities.h>

#include <QAbstractButton>
#include <QComboBox>
#include <QString>
#include <QWidget>

#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

void expect_words(const char* button, const char* words) {
  const QString there = find<QAbstractButton>(button).text();
  expect(there.startsWith(QString::fromUtf8(words)),
         std::string(button) + " says \"" + words + "\", not \"" + there.toStdString() + '"');
}

/// A toolbar lays out anew, after an event, what another button's words have moved.
void expect_in_sight(const char* name) {
  const QWidget& of = find<QWidget>(name);
  wait_for(
      std::string(name) + " is in sight",
      [&of] {
        const QRect place(of.mapTo(pqCoreUtilities::mainWidget(), QPoint(0, 0)), of.size());
        return of.isVisible() && pqCoreUtilities::mainWidget()->rect().contains(place);
      },
      5);
}

void the_panel_speaks_german() {
  scan_is_shown();
  expect_words("palpateRelease", "Loslassen  (Esc)");
  expect_words("palpateToolbarRelease", "Loslassen  (Esc)");
  expect_words("palpateConnect", "Verbinden");
  expect(find<QComboBox>("palpateDirection0").currentText() == "hinein", "and what is chosen from");
  expect_words("palpateFeel", "Fühlen");
  expect_words("palpateScanSectionFold", "Aufnahme");
  expect_words("palpateTissuesSectionFold", "Gewebe");
  expect_words("palpateStylusSectionFold", "Stift");
  expect(find<QAbstractButton>("palpateToolbarRelease").toolTip().startsWith("Nimmt die Kraft weg"),
         "tool tips are German, too");
  expect(corner_text("Axial").contains("Axial") && corner_text("Koronal").contains("Koronal"), "so are the views");
  const auto state_is = [](const char* words) { return label("palpateState") == QString::fromUtf8(words); };
  wait_for(
      "the state line is German", [&] { return state_is("Aus: es ist kein Stift verbunden"); }, 20);
  click("palpateConnect");
  wait_for(
      "and what it says of a stylus", [&] { return state_is("Bereit: keine Kraft. Fühlen schaltet sie ein"); }, 20);
  expect_words("palpateConnect", "Trennen");
  click("palpateFeel");
  wait_for(
      "and of forces", [&] { return state_is("Fühlen: die Kraft ist an"); }, 20);
  expect_in_sight("palpateToolbarRelease");
  expect_in_sight("palpateRelease");
  save_screen("german");
  click("palpateRelease");
  wait_for(
      "nothing is felt", [&] { return !state_is("Fühlen: die Kraft ist an"); }, 20);
}

void the_setting_says_english() {
  scan_is_shown();
  expect_words("palpateRelease", "Release  (Esc)");
  wait_for(
      "the state line is English", [] { return label("palpateState") == "Off: no stylus is connected"; }, 20);
}

}  // namespace

const Scenarios& language_scenarios() {
  static const Scenarios scenarios{{"the_panel_speaks_german", the_panel_speaks_german},
                                   {"the_setting_says_english", the_setting_says_english}};
  return scenarios;
}
