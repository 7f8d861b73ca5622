#pragma once

/// A user of the panel, in the real program: finds widgets by name, clicks, drags, types, waits and looks. Everything
/// throws std::runtime_error saying what was expected where it does not come.

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

/// The main window as a picture in the folder that PALPATE_PICTURES names.
void save_screen(const std::string& name);

void expect(bool holds, const std::string& what);
/// Events are handled meanwhile.
void wait_for(const std::string& what, const std::function<bool()>& holds, int seconds = 60);
void wait_ms(int ms);
/// Whether it comes true in time. Events are handled meanwhile.
bool comes_true(const std::function<bool()>& holds, int seconds = 20);
/// Handles events so often, for 10 ms or more each time: on a slow machine for longer.
void handle_events(int times);
/// What `text` tells once it stays: the same while events are handled so often, a hundred times for a second or more.
QString steady(const std::string& what, const std::function<QString()>& text, int turns = 100);
/// Until the pictures of all views on the screen have stayed for 1.5 s or more, or 20 s have gone by.
void views_rest();
/// Until the widget is seen, and has kept its place and size.
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
/// The number that a label begins with.
double number(const char* name);
/// The same once it stays, as a hand that trembles lets it: within half a percent for a hundred turns of events.
double steady_number(const char* name);

/// Clicks so far: what a user's finger does.
int clicks();
void click(const char* name);
void click(QWidget& on, const QPoint& at);
void press_key(int key);
/// By the display, wherever the pointer is: goes to what has the keyboard. By X11's name of the key.
void type_key(const char* key);
/// Clicks on a button that opens a dialog, and does in it what a user does. Fails where no dialog comes.
void in_dialog(const char* button, const std::function<void(QDialog&)>& act);
/// The same where something else opens it; `what` says what.
void in_dialog_of(const std::string& what, const std::function<void()>& open, const std::function<void(QDialog&)>& act);
/// Clicks on a button that asks for a file, and names it.
void name_file(const char* button, const QString& file);
/// The same where it is to be written at once.
void save_as(const char* button, const QString& file);
/// In a view, by X11's name of the key: the pointer is there, and has clicked beside everything.
void press_key_in(QWidget& view, const char* key);
/// Keeps a key down there, or lets it go.
void hold_key_in(QWidget& view, const char* key, bool down);

/// A clinical view: "Axial", "Sagittal", "Coronal", "Volume". Throws where there is none.
pqRenderView& render_view(const char* name);
/// The widget of a clinical view: "Axial", "Sagittal", "Coronal", "Volume".
QWidget& view(const char* name);
/// The middle of the stylus' yellow proxy in a view's picture, pixels; nothing where it is not seen.
std::optional<QPoint> proxy_now(QWidget& view);
/// The same once it is seen and stays there.
QPoint proxy_in(QWidget& view);
/// What stands in the corner of a slice view, and what is told of the place under its pointer.
QString corner_text(const char* view);
QString pointer_text(const char* view);
/// Who was scanned, as it stands in its upper right corner; where the slice lies, in its lower right. Empty: hidden.
QString identity_text(const char* view);
QString place_text(const char* view);
/// What was measured in it, as it is seen: "23.4 mm".
QStringList measured_in(const char* view);
/// The pointer in the middle of a view, and its wheel turned: up for more than 0.
void turn_wheel(const char* view, int steps);
/// The pointer moved with Shift held down to a place in parts of the view, from the left and from below.
void point_with_shift(const char* view, double x, double y);
/// Brings it into sight, as a user scrolls.
void scroll_to(QWidget& to);
/// The same where the column has just changed, and until `shown` is laid out.
void scroll_to(QWidget& to, const QWidget& shown);
void move_pointer(const QWidget& in, const QPoint& at);
/// Presses at `from` and moves to `to` in steps; lets go only where asked to.
void drag(QWidget& view, const QPoint& from, const QPoint& to, bool let_go);
void let_go();
void double_click(QWidget& view, const QPoint& at);
