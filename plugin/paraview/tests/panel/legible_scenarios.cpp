// Legibility: no control moves away under the pointer, no text is cut off, and nothing of ParaView's covers the panel.

#include <pqCoreUtilities.h>
#include <vtkOutputWindow.h>

#include <QAbstractButton>
#include <QAbstractItemModel>
#include <QAction>
#include <QApplication>
#include <QComboBox>
#include <QImage>
#include <QLabel>
#include <QLineEdit>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QScrollArea>
#include <QStyleOptionComboBox>
#include <QToolButton>
#include <QTreeView>
#include <QTreeWidget>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

QMainWindow& host_window() {
  return *qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
}

/// Where a hand finds what it presses while it feels, on the screen.
std::map<std::string, QPoint> places() {
  std::map<std::string, QPoint> all;
  for (const char* const name :
       {"palpateOn0", "palpateStrength0", "palpateConnect", "palpateForceLimit", "palpateClutch", "palpateRecord",
        "palpateTechnical", "palpateFeel", "palpateMark", "palpateRelease", "palpateToolbarRelease"}) {
    const QWidget& one = find<QWidget>(name);
    all[name] = one.mapToGlobal(QPoint(0, 0));
  }
  return all;
}

void expect_in_place(const std::map<std::string, QPoint>& before, const std::string& when) {
  handle_events(20);
  std::string moved;
  for (const auto& [name, at] : places()) {
    const QPoint by = at - before.at(name);
    if (!by.isNull()) moved += " " + name + " by " + std::to_string(by.x()) + ", " + std::to_string(by.y());
  }
  if (!moved.empty()) save_screen("jumped");
  expect(moved.empty(), when + " nothing moves:" + moved);
}

/// On a scan with a structure: its distance, a long state line and messages come and go.
void nothing_moves_under_the_pointer() {
  scan_is_shown();
  click("palpateStructuresSectionFold");
  auto& list = find<QTreeWidget>("palpateStructureList");
  wait_for(
      "a structure is listed and measured",
      [&] { return list.topLevelItemCount() == 1 && !list.topLevelItem(0)->text(1).isEmpty(); }, 60);
  QWidget& boundary = find<QWidget>("palpateStructureBoundary");
  scroll_to(boundary);
  const QPoint pressed = boundary.mapToGlobal(QPoint(0, 0));
  click("palpateStructureBoundary");
  wait_for(
      "it is felt", [] { return steady_scene().find("Liver") != std::string::npos; }, 20);
  handle_events(20);
  const int moved = boundary.mapToGlobal(QPoint(0, 0)).y() - pressed.y();
  save_screen("boundary-pressed");
  expect(moved == 0, "the button stays where it was pressed, and does not go down by " + std::to_string(moved));
  click("palpateStructuresSectionFold");
  scroll_to(find<QWidget>("palpateClutch"));
  is_laid_out(find<QWidget>("palpateClutch"));
  const auto before = places();
  click("palpateConnect");
  wait_for("it is connected", [] { return label("palpateState").startsWith("Ready"); });
  expect_in_place(before, "where a stylus is connected");
  turn_forces_on();
  expect_in_place(before, "where the force is on");
  press();
  wait_for(
      "the distance is told", [] { return find<QLabel>("palpateDistance").isVisible(); }, 20);
  expect_in_place(before, "in contact");
  hang();
  wait_for(
      "the fault is told", [] { return label("palpateState").startsWith("Stopped: "); }, 20);
  expect_in_place(before, "in a fault");
  let_go();
  click("palpateFeel");  // "Clear fault"
  wait_for(
      "it is ready", [] { return label("palpateState").startsWith("Ready"); }, 20);
  click("palpateConnect");
  wait_for("it is disconnected", [] { return label("palpateState").startsWith("Off"); });
  expect_in_place(before, "where the stylus is disconnected");
}

/// With "…" at its end or in its middle.
bool is_shortened(const QString& shown, const QString& whole) {
  const auto cut = shown.indexOf(QStringLiteral("…"));
  return cut >= 0 && whole.startsWith(shown.left(cut).trimmed()) && whole.endsWith(shown.mid(cut + 1).trimmed());
}

/// How many pixels of a text do not fit; 0: it is whole, or its tool tip says all of it.
int cut_off(const QWidget& of) {
  if (const auto* const text = qobject_cast<const QLabel*>(&of)) {
    if (text->text().isEmpty() || is_shortened(text->text(), text->toolTip())) return 0;
    return text->wordWrap() ? std::max(text->heightForWidth(text->width()) - text->height(), 0)
                            : std::max(text->sizeHint().width() - text->width(), 0);
  }
  const auto* const tool = qobject_cast<const QToolButton*>(&of);
  if (tool && tool->toolButtonStyle() == Qt::ToolButtonIconOnly) return 0;
  if (const auto* const button = qobject_cast<const QAbstractButton*>(&of)) {
    if (button->text().isEmpty() || is_shortened(button->text(), button->toolTip())) return 0;
    const int wide = button->fontMetrics().size(Qt::TextShowMnemonic, button->text()).width();
    return std::max(wide - button->width(), 0);
  }
  if (const auto* const box = qobject_cast<const QComboBox*>(&of)) {
    QStyleOptionComboBox option;
    option.initFrom(box);
    const int room =
        box->style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField, box).width();
    const bool told = box->toolTip().startsWith(box->currentText());
    return told ? 0 : std::max(box->fontMetrics().horizontalAdvance(box->currentText()) - room, 0);
  }
  if (const auto* const line = qobject_cast<const QLineEdit*>(&of)) {
    if (line->inherits("palpate::plugin::ShortenedEdit") && line->toolTip() == line->text()) return 0;
    return std::max(line->fontMetrics().horizontalAdvance(line->text()) - line->width(), 0);
  }
  return 0;
}

/// All sections unfolded, with a stylus, in the window that ParaView opens at first and with the panel's first width.
void no_text_is_cut_off() {
  scan_is_shown();
  click("palpateConnect");  // the words of its state are another language's
  click("palpateFeel");
  wait_ms(1000);
  QWidget& panel = find<QWidget>("PalpatePanel");
  for (auto* const fold : panel.findChildren<QAbstractButton*>()) {
    if (fold->objectName().endsWith("SectionFold") && !fold->isChecked()) fold->click();
  }
  click("palpateTechnical");
  handle_events(100);
  is_laid_out(panel);
  std::string cut;
  for (const QWidget* const one :
       panel.findChildren<QWidget*>() + find<QWidget>("palpateToolbar").findChildren<QWidget*>()) {
    if (!one->isVisible()) continue;
    if (const int pixels = cut_off(*one); pixels > 1) {
      QString text = one->property("text").toString();
      if (text.isEmpty()) text = one->property("currentText").toString();
      cut += "; " + one->objectName().toStdString() + " \"" + text.toStdString() + "\" by " + std::to_string(pixels);
    }
  }
  save_screen("texts-" + qEnvironmentVariable("LC_ALL").toStdString());
  expect(cut.empty(), "no text is cut off:" + cut);
}

/// By the contrast that WCAG 2 asks of a text of that size, 4.5 : 1.
double contrast(const QColor& one, const QColor& other) {
  const auto luminance = [](const QColor& color) {
    const auto linear = [](double part) {
      return part <= 0.03928 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
    };
    return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) + 0.0722 * linear(color.blueF());
  };
  const double a = luminance(one) + 0.05, b = luminance(other) + 0.05;
  return std::max(a, b) / std::min(a, b);
}

/// The darkest and the lightest pixel of what says that this is research software.
void the_notice_is_legible() {
  scan_is_shown();
  auto& notice = find<QLabel>("palpateAbout");
  expect(notice.text().contains("not a medical device"), "it says what this is");
  scroll_to(notice);
  is_laid_out(notice);
  const QImage picture = notice.grab().toImage();
  QColor darkest = Qt::white, lightest = Qt::black;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const QColor at = picture.pixelColor(x, y);
      if (at.lightness() < darkest.lightness()) darkest = at;
      if (at.lightness() > lightest.lightness()) lightest = at;
    }
  }
  const double found = contrast(darkest, lightest);
  expect(found >= 4.5, "its contrast is 4.5 or more: " + std::to_string(found));
  expect(notice.fontInfo().pixelSize() >= 11, "it is not small");
}

/// A name for one thing: in ParaView's menus and ours.
void a_menu_names_one_thing() {
  scan_is_shown();
  int entries = 0;
  for (const QAction* const top : host_window().menuBar()->actions()) {
    if (!top->menu()) continue;
    std::set<QString> here;
    for (const QAction* const one : top->menu()->actions()) {
      QString words = one->text().remove('&').remove(QStringLiteral("...")).remove(QStringLiteral("…")).trimmed();
      if (words.isEmpty() || !one->isVisible()) continue;
      expect(here.insert(words).second, "a menu has one entry of that name: " + words.toStdString());
      ++entries;
    }
  }
  expect(entries > 30, "ParaView's menus are there");
}

/// How many lines ParaView's own messages have.
int host_messages() {
  int rows = 0;
  for (QWidget* const one : QApplication::allWidgets()) {
    if (!one->inherits("pqOutputWidget")) continue;
    for (const auto* const view : one->findChildren<QTreeView*>())
      rows += view->model() ? view->model()->rowCount() : 0;
  }
  return rows;
}

/// What is not there is said in the panel, and not by ParaView's messages.
void a_missing_folder_is_told_in_the_panel() {
  const int before = host_messages();
  const QString missing = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/no such folder");
  drop_folder(missing);
  wait_for(
      "it is said", [&] { return label("palpateMessage").contains("no such folder"); }, 20);
  wait_ms(1000);
  save_screen("missing-folder");
  expect(host_messages() == before, "ParaView says nothing");
  vtkOutputWindowDisplayWarningText("the scenario's own warning\n");
  expect(comes_true([before] { return host_messages() > before; }), "and this would be seen");
}

/// In a program that was not told to leave ParaView's welcome out.
void the_start_page_is_the_welcome() {
  int seen = 0;
  for (int n = 0; n < 30; ++n) {
    for (QWidget* const top : QApplication::topLevelWidgets()) {
      if (!top->inherits("pqWelcomeDialog") || !top->isVisible()) continue;
      ++seen;
      top->close();  // the program would not end behind it
    }
    wait_ms(100);
  }
  save_screen("welcome");
  expect(find<QScrollArea>("palpateStart").isVisible(), "the start page is there");
  expect(seen == 0, "and nothing stands in front of it: " + std::to_string(seen));
}

}  // namespace

const Scenarios& legible_scenarios() {
  static const Scenarios all{{"nothing_moves_under_the_pointer", nothing_moves_under_the_pointer},
                             {"no_text_is_cut_off", no_text_is_cut_off},
                             {"the_notice_is_legible", the_notice_is_legible},
                             {"a_menu_names_one_thing", a_menu_names_one_thing},
                             {"a_missing_folder_is_told_in_the_panel", a_missing_folder_is_told_in_the_panel},
                             {"the_start_page_is_the_welcome", the_start_page_is_the_welcome}};
  return all;
}
