// The display of a tuned scene, and small faults of the panel that were once present.

#include <QAbstractItemModel>
#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFontMetrics>
#include <QImage>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QListWidget>
#include <QProcess>
#include <QPushButton>
#include <QRegularExpression>
#include <QScrollArea>
#include <QString>
#include <QStringList>
#include <QToolButton>
#include <QWidget>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// Where a chart has its mark, pixels from the left; -1: none.
int mark_in(QWidget& chart) {
  const QImage picture = chart.grab().toImage();
  for (int x = 0; x < picture.width(); ++x) {
    int marked = 0;
    for (int y = 0; y < picture.height(); ++y) {
      const QColor color = picture.pixelColor(x, y);
      marked += color.red() > 170 && color.green() > 60 && color.green() < 130 && color.blue() < 60 ? 1 : 0;
    }
    if (marked > 0.6 * picture.height()) return x;
  }
  return -1;
}

/// "L 1.0 P 2.0 H 3.0 mm   41 HU".
double value_under_pointer() {
  const auto match = QRegularExpression(QStringLiteral("(-?[0-9]+) HU$")).match(pointer_text("Coronal"));
  expect(match.hasMatch(), "a value is told in whole HU: " + pointer_text("Coronal").toStdString());
  return match.captured(1).toDouble();
}

/// The least and the greatest value of the gate's histogram.
std::pair<double, double> range_of_gate() {
  const auto match =
      QRegularExpression(QStringLiteral(",[^0-9-]+(-?[0-9]+)[^0-9-]+(-?[0-9]+)")).match(label("palpateGateCurveAxes"));
  expect(match.hasMatch(), "the axes are in words: " + label("palpateGateCurveAxes").toStdString());
  return {match.captured(1).toDouble(), match.captured(2).toDouble()};
}

/// The values of the nodes of the first boundary's gate.
std::vector<double> gate_nodes() {
  std::vector<double> at;
  const auto scene = QJsonDocument::fromJson(QByteArray::fromStdString(scene_text())).object();
  for (const auto& gate : scene["modes"].toArray().first().toObject()["gates"].toArray()) {
    if (gate.toObject()["of"].toString("value") != "value") continue;
    for (const auto& node : gate.toObject()["nodes"].toArray()) at.push_back(node.toArray().first().toDouble());
  }
  return at;
}

void type(const char* what, const char* key) {
  QProcess::execute(QStringLiteral("xdotool"), {QString::fromLatin1(what), QString::fromLatin1(key)});
  wait_ms(300);
}

void expect_marks() {
  QWidget& chart = find<QWidget>("palpateGateCurveChart");
  QWidget& coronal = view("Coronal");
  const auto [low, high] = range_of_gate();
  std::vector<std::pair<double, int>> marks;
  // Bone and soft tissue.
  for (const double part : {0.25, 0.75}) {
    move_pointer(coronal, QPoint(static_cast<int>(part * coronal.width()), coronal.height() * 6 / 10));
    steady("what is pointed at", [&] { return pointer_text("Coronal") + QString::number(mark_in(chart)); });
    const int at = mark_in(chart);
    expect(at >= 0, "what is pointed at is marked");
    marks.emplace_back(value_under_pointer(), at);
  }
  const double values = (marks[0].first - marks[1].first) / (high - low);
  const double pixels = static_cast<double>(marks[0].second - marks[1].second) / chart.width();
  expect(std::abs(values) > 0.05 && std::abs(pixels - values) < 0.03,
         "the marks are as far apart as the values: " + std::to_string(pixels) + ", " + std::to_string(values));
  save_screen("marked");
}

void expect_block() {
  QWidget& chart = find<QWidget>("palpateGateCurveChart");
  const auto [low, high] = range_of_gate();
  const std::vector<double> before = gate_nodes();
  expect(before.size() > 1, "the gate has nodes");
  const int across = chart.width() / 12;
  const QPoint from(chart.width() / 2, chart.height() / 2);
  type("keydown", "shift");
  drag(chart, from, from + QPoint(across, 0), true);
  type("keyup", "shift");
  const double by = (high - low) * across / chart.width();
  wait_for(
      "the gate has moved", [&] { return gate_nodes() != before; }, 20);
  steady_scene();
  const std::vector<double> after = gate_nodes();
  expect(after.size() == before.size(), "it has as many nodes as before");
  for (std::size_t n = 0; n < after.size(); ++n) {
    expect(std::abs(after[n] - before[n] - by) < 0.15 * by, "all by the same: node " + std::to_string(n) + " by " +
                                                                std::to_string(after[n] - before[n]) + ", not " +
                                                                std::to_string(by));
  }
}

void expect_before_and_after() {
  auto& strength = find<QDoubleSpinBox>("palpateStrength0");
  const double before = strength.value(), after = before / 2;
  strength.setValue(after);
  steady_scene();
  press_key_in(view("Coronal"), "Home");  // the pointer is there, and the keyboard
  type("keydown", "b");
  wait_for(
      "while the key is held it is as before", [&] { return std::abs(strength.value() - before) < 0.006; }, 20);
  const std::string edited = steady_scene();
  // Other keys that are held at the end keep it from nothing.
  type("keydown", "shift");
  type("keyup", "b");
  wait_for(
      "and then as it was edited", [&] { return std::abs(strength.value() - after) < 0.006; }, 20);
  type("keyup", "shift");
  // A mark that is made meanwhile is a step of its own.
  connect_stylus();
  press_key_in(view("Coronal"), "Home");
  type("keydown", "b");
  wait_for(
      "it is as before", [&] { return std::abs(strength.value() - before) < 0.006; }, 20);
  click("palpateMark");
  wait_for(
      "a mark is made", [] { return !marks_text().empty(); }, 20);
  type("keyup", "b");
  wait_for(
      "the edit is there again", [&] { return std::abs(strength.value() - after) < 0.006; }, 20);
  expect(scene_text() == edited, "and the pipeline had it all the time");
  click("palpateConnect");
}

void expect_alike() {
  const auto marked = [](const char* name) { return find<QLabel>(name).isVisible(); };
  auto& first = find<QDoubleSpinBox>("palpateStrength0");
  auto& second = find<QDoubleSpinBox>("palpateStrength1");
  for (int row = 2; QWidget* const other = widget(("palpateOn" + std::to_string(row)).c_str()); ++row) {
    if (static_cast<QCheckBox*>(other)->isChecked()) static_cast<QCheckBox*>(other)->click();
  }
  first.setValue(2);
  second.setValue(1.9);
  wait_for(
      "a hand cannot tell 1.9 N from 2 N",
      [&] { return marked("palpateAlike0") && marked("palpateAlike1") && !marked("palpateAlike2"); }, 20);
  expect(find<QLabel>("palpateAlike0").toolTip().contains("a tenth"), "and it is said why");
  save_screen("alike");
  second.setValue(1.6);
  wait_for(
      "but 1.6 N", [&] { return !marked("palpateAlike0") && !marked("palpateAlike1"); }, 20);
}

void a_scene_shows_what_it_does() {
  scan_is_shown();
  click("palpateCurvesSectionFold");
  scroll_to(find<QWidget>("palpateGateCurveValue"), find<QWidget>("palpateGateCurveChart"));
  expect_marks();
  expect_block();
  expect_before_and_after();
  scroll_to(find<QWidget>("palpateOn0"));
  expect_alike();
}

void expect_fits(const char* name) {
  auto& text = find<QLabel>(name);
  const QRect needed = text.fontMetrics().boundingRect(QRect(0, 0, text.width(), 1000), Qt::TextWordWrap, text.text());
  expect(needed.width() <= text.width() && needed.height() <= text.height() + 2,
         std::string(name) + " is not cut: " + std::to_string(needed.width()) + " x " +
             std::to_string(needed.height()) + " in " + std::to_string(text.width()) + " x " +
             std::to_string(text.height()));
}

/// Of a row through the strip, the part that is drawn on: a dashed line about a half.
double drawn_part(const QImage& strip, int y) {
  const QColor paper = strip.pixelColor(strip.width() / 2, 2);
  int drawn = 0;
  for (int x = strip.width() / 4; x < strip.width(); ++x) {
    drawn += std::abs(strip.pixelColor(x, y).value() - paper.value()) > 40 ? 1 : 0;
  }
  return drawn / (0.75 * strip.width());
}

void small_things_are_right() {
  scan_is_shown();
  find<QDoubleSpinBox>("palpateForceLimit").setValue(0.5);
  connect_stylus();
  press();
  let_go();
  // The strip's line is the limit, 1 / 1.1 of its height, and not its half.
  wait_for(
      "the strip has the limit's scale",
      [] {
        QWidget& strip = find<QWidget>("palpateStrip");
        const QImage picture = strip.grab().toImage();
        const int limit = static_cast<int>(std::lround(strip.height() - 1 - (strip.height() - 4) / 1.1));
        double most = 0;
        for (int y = limit - 1; y <= limit + 1; ++y) most = std::max(most, drawn_part(picture, y));
        return most > 0.3 && drawn_part(picture, strip.height() / 2) < 0.3;
      },
      20);
  save_screen("strip");
  click("palpateCurvesSectionFold");
  scroll_to(find<QWidget>("palpateGateCurveValue"), find<QWidget>("palpateGateCurveAxes"));
  expect_fits("palpateStrengthCurveAxes");
  expect_fits("palpateGateCurveAxes");
  move_pointer(view("Axial"), view("Axial").rect().center() + QPoint(7, 9));
  const QRegularExpression whole(QStringLiteral(" -?[0-9]+ HU$"));
  expect(comes_true([&] { return whole.match(pointer_text("Axial")).hasMatch(); }),
         "HU are whole: " + pointer_text("Axial").toStdString());
  // One column scrolls, and nothing within it.
  int scrollers = 0;
  for (QWidget* above = &find<QWidget>("palpateOn0"); above; above = above->parentWidget()) {
    scrollers += qobject_cast<QScrollArea*>(above) ? 1 : 0;
  }
  expect(scrollers == 1, "the tissues scroll with the panel alone: " + std::to_string(scrollers));
}

/// Six series of one folder: all in sight. Their pictures may come late: each row has room for its own from the start.
void series_are_listed_in_full() {
  auto& series = find<QListWidget>("palpateSeries");
  const auto rows = std::make_shared<int>(0);
  QObject::connect(series.model(), &QAbstractItemModel::rowsInserted, &series,
                   [&series, rows](const QModelIndex&, int first, int last) {
                     for (int n = first; n <= last; ++n) *rows += series.item(n)->icon().isNull() ? 0 : 1;
                   });
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  wait_for("the series are listed", [&] { return series.count() > 5; });
  expect(*rows == series.count(), "each with room for its picture");
  wait_for(
      "the last of six rows is in sight",
      [&] { return series.viewport()->rect().contains(series.visualItemRect(series.item(series.count() - 1))); }, 20);
  save_screen("series");
}

/// A CT whose files say CHEST.
void scenes_are_offered_by_the_part() {
  scan_is_shown();
  auto& scenes = find<QComboBox>("palpateScenes");
  expect(scenes.itemText(1) == "CT: chest", "the chest's scene is the first: " + scenes.itemText(1).toStdString());
  const int last_ct = scenes.findText("CT: vessels"), brain = scenes.findText("MR: brain"),
            flow = scenes.findText("Flow");
  expect(last_ct > 1 && last_ct < brain && last_ct < flow, "those of other scans come last");
  expect(scenes.itemData(brain, Qt::ToolTipRole).toString().startsWith("Made for MR"), "and it is said why");
  expect(scenes.itemData(last_ct, Qt::ToolTipRole).toString().isEmpty(), "of the others nothing is said");
  scenes.setCurrentIndex(1);
  emit scenes.activated(1);
  wait_for(
      "it is taken", [] { return QString::fromStdString(scene_text()).contains("CT: chest"); }, 20);
}

/// What was refused is said in the section in which it was pressed, in red, and nowhere else; and it goes back.
void a_refusal_stands_beside_its_button() {
  scan_is_shown();
  connect_stylus();
  // As many modes as a scene can have.
  click("palpateModesSectionFold");
  QAction& add = *widget("palpateModes")->findChild<QAction*>("palpateAdd_friction");
  for (int n = 0; n < 100 && !find<QLabel>("palpateModesMessage").isVisible(); ++n) {
    add.trigger();
    handle_events(5);
  }
  const std::string scene = steady_scene();
  const auto is_refused = [&](const char* message, const char* words) {
    wait_for(
        std::string(message) + " says: " + words,
        [&] { return find<QLabel>(message).isVisible() && label(message).contains(words); }, 20);
    expect(find<QLabel>(message).styleSheet().contains("bold"), "as a problem");
    for (const char* const other : {"palpateMessage", "palpateModesMessage", "palpateFilterMessage",
                                    "palpateStylusMessage", "palpateCurveMessage", "palpateSceneMessage"}) {
      expect(std::string(other) == message || !label(other).contains(words), std::string(other) + " does not");
    }
    expect(steady_scene() == scene, "the scene is as it was");
  };
  auto& modes = find<QListWidget>("palpateModeList");
  const int listed = modes.count();
  add.trigger();
  is_refused("palpateModesMessage", "modes");
  expect(modes.count() == listed, "the list has the modes that are felt");
  scroll_to(find<QLabel>("palpateModesMessage"));
  save_screen("refused-mode");
  // A recording that cannot be written.
  name_file("palpateRecord", "/proc/session.h5");
  is_refused("palpateStylusMessage", "/proc/session.h5");
  expect(find<QPushButton>("palpateRecord").text() != "Stop recording", "nothing is recorded");
}

void words_for_developers_stand_under_technical() {
  scan_is_shown();
  auto& technical = find<QToolButton>("palpateTechnical");
  click("palpateModesSectionFold");
  connect_stylus();
  const auto shown = [] {
    QStringList seen;
    for (const QLabel* const text : find<QWidget>("PalpatePanel").findChildren<QLabel*>()) {
      if (text->isVisible()) seen << text->text();
    }
    return seen.join(QLatin1Char('\n'));
  };
  const auto expect_texts = [&](bool there) {
    const QString all = shown();
    for (const char* const word : {"gradient bricks|brick", "Hessian", "solver", "tick", "own limits: "}) {
      const bool is = all.contains(QRegularExpression(QStringLiteral("\\b(%1)").arg(QLatin1String(word))));
      if (!there) expect(!is, std::string("nothing tells of ") + word + ": " + all.toStdString());
    }
    expect(all.contains("own limits: ") == there && all.contains("solver") == there && all.contains("tick") == there,
           std::string(there ? "with" : "without") + " Technical: " + all.toStdString());
  };
  expect(!technical.isChecked(), "at first it is off");
  expect_texts(false);
  technical.click();
  wait_for(
      "what the stylus limits itself is told", [] { return find<QLabel>("palpateOwnLimits").isVisible(); }, 20);
  wait_for(
      "so is what a tick takes, and by which solver",
      [&] { return shown().contains("tick") && shown().contains("solver"); }, 10);
  expect_texts(true);
  expect(find<QLabel>("palpatePlan").isVisible(), "what is left out is told, too");
  save_screen("technical");
}

}  // namespace

const Scenarios& tuning_scenarios() {
  static const Scenarios scenarios{
      {"a_scene_shows_what_it_does", a_scene_shows_what_it_does},
      {"small_things_are_right", small_things_are_right},
      {"scenes_are_offered_by_the_part", scenes_are_offered_by_the_part},
      {"a_refusal_stands_beside_its_button", a_refusal_stands_beside_its_button},
      {"words_for_developers_stand_under_technical", words_for_developers_stand_under_technical},
      {"series_are_listed_in_full", series_are_listed_in_full}};
  return scenarios;
}
