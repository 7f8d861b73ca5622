#include "plugin/paraview/tests/panel/mark_steps.h"

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"
#include "plugin/report/kept_marks.h"

using namespace palpate;

QTreeWidget& mark_list() {
  return find<QTreeWidget>("palpateMarkList");
}

QString beside_pictures(const char* name) {
  return qEnvironmentVariable("PALPATE_PICTURES") + QLatin1Char('/') + QLatin1String(name);
}

plugin::Marks kept_marks() {
  const plugin::MarksOfScans all = plugin::marks_of_text(marks_text());
  expect(all.size() <= 1, "one scan has marks");
  return all.empty() ? plugin::Marks() : all.begin()->second;
}

void has_rows(int count, const std::string& what) {
  wait_for(
      what, [&] { return mark_list().topLevelItemCount() == count; }, 20);
}

void touch_surface() {
  QWidget& coronal = view("Coronal");
  for (int n = 0; n < 60 && number("palpateForce") < 0.3; ++n) {
    step_hand(coronal, "Prior");
    stylus_rests();
  }
  wait_for(
      "a force is felt", [] { return number("palpateForce") > 0.2; }, 20);
}

void step(const char* key, int times) {
  for (int n = 0; n < times; ++n) step_hand(view("Coronal"), key);
  stylus_rests();
}

void mark_by_key() {
  const int before = mark_list().topLevelItemCount();
  press_key_in(view("Coronal"), "m");
  has_rows(before + 1, "the key M marks");
}

void go_to(const char* key, int times) {
  step("Next", 8);
  step(key, times);
  touch_surface();
}

void mark_three() {
  touch_surface();
  mark_by_key();
  go_to("Left", 8);
  click("palpateMark");
  has_rows(2, "the button marks");
  go_to("Down", 8);
  mark_by_key();
}

void choose_marks(const std::vector<int>& rows) {
  mark_list().clearSelection();
  for (const int row : rows) mark_list().topLevelItem(row)->setSelected(true);
}
