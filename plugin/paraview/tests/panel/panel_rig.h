#pragma once

/// A simulated user of the panel in the real program: finds widgets by name, clicks, drags, types, waits and looks. All
/// functions throw std::runtime_error with the expectation that was not met.

#include <QDialog>
#include <QPoint>
#include <QString>
#include <QStringList>
#include <QWidget>

#include <functional>
#include <optional>
#include <string>

class pqRenderView;

/// Runs one of the scenarios.
void run_scenario(const std::string& name);

/// Saves a picture of the main window in the folder PALPATE_PICTURES.
void save_screen(const std::string& name);

void expect(bool holds, const std::string& what);
/// Handles events while waiting.
void wait_for(const std::string& what, const std::function<bool()>& holds, int seconds = 60);
void wait_ms(int ms);
/// Whether it becomes true in time, while events are handled.
bool comes_true(const std::function<bool()>& holds, int seconds = 20);
/// Handles events this many times, for 10 ms or more each; longer on a slow machine.
void handle_events(int times);
/// The text once it stays the same while events are handled this many times; a hundred take a second or more.
QString steady(const std::string& what, const std::function<QString()>& text, int turns = 100);
/// Waits until the pictures of all visible views have not changed for 1.5 s or more, at most 20 s.
void views_rest();
/// Waits until the widget is visible, and has kept its place and size.
void is_laid_out(const QWidget& shown);

QWidget* widget(const char* name);
template <typename Widget>
Widget& find(const char* name) {
  auto* const found = qobject_cast<Widget*>(widget(name));
  expect(found != nullptr, std::string("there is a widget ") + name);
  return *found;
}
/// Text of a label.
QString label(const char* name);
/// The number that a label begins with, perhaps after "Volume".
double number(const char* name);
/// The number once it changes by half a percent at most (a hand's tremor) during a hundred turns of events.
double steady_number(const char* name);

/// The number of clicks so far.
int clicks();
void click(const char* name);
void click(QWidget& on, const QPoint& at);
void press_key(int key);
/// Types a key, by its X11 name, through the display, wherever the pointer is: it goes to the widget with the focus.
void type_key(const char* key);
/// Clicks a button that opens a dialog, and calls `act` in it. Fails if no dialog opens.
void in_dialog(const char* button, const std::function<void(QDialog&)>& act);
/// The same if something else opens it; `what` names that.
void in_dialog_of(const std::string& what, const std::function<void()>& open, const std::function<void(QDialog&)>& act);
/// Clicks a button that asks for a file, and enters its name.
void name_file(const char* button, const QString& file);
/// The same for a file that is written at once.
void save_as(const char* button, const QString& file);
/// Presses a key, by its X11 name, in a view: moves the pointer there and first clicks on an empty place.
void press_key_in(QWidget& view, const char* key);
/// Presses or releases a key there.
void hold_key_in(QWidget& view, const char* key, bool down);

/// A clinical view: "Axial", "Sagittal", "Coronal", "Volume". Throws if it does not exist.
pqRenderView& render_view(const char* name);
/// The widget of a clinical view: "Axial", "Sagittal", "Coronal", "Volume".
QWidget& view(const char* name);
/// The middle of the stylus' yellow proxy in a view's picture, pixels; nothing if it is not visible.
std::optional<QPoint> proxy_now(QWidget& view);
/// The same once it is visible and steady.
QPoint proxy_in(QWidget& view);
/// The text in the corner of a slice view, including that about the place under its pointer.
QString corner_text(const char* view);
QString pointer_text(const char* view);
/// The patient's identity in its upper right corner; the slice's position in its lower right. Empty: hidden.
QString identity_text(const char* view);
QString place_text(const char* view);
/// The measurements shown in it: "23.4 mm".
QStringList measured_in(const char* view);
/// Moves the pointer to the middle of a view and turns the wheel: up for steps > 0.
void turn_wheel(const char* view, int steps);
/// Moves the pointer with Shift held down to a place, in fractions of the view from the left and from below.
void point_with_shift(const char* view, double x, double y);
/// Scrolls it into view, as a user does.
void scroll_to(QWidget& to);
/// The same just after the column has changed; waits until `shown` is laid out.
void scroll_to(QWidget& to, const QWidget& shown);
void move_pointer(const QWidget& in, const QPoint& at);
/// Presses at `from` and moves to `to` in steps; releases only if `let_go`.
void drag(QWidget& view, const QPoint& from, const QPoint& to, bool let_go);
void let_go();
void double_click(QWidget& view, const QPoint& at);
