#pragma once

/// Common first steps of the scenarios.

#include <QString>
#include <QWidget>

#include <map>
#include <memory>
#include <string>

#include "plugin/session/servo_clock.h"

class QDialog;
class pqPipelineSource;

namespace palpate::plugin {
class Caster;
class SessionController;
}  // namespace palpate::plugin

/// A scenario by its name.
using Scenarios = std::map<std::string, void (*)()>;

/// The scenarios of the files with that name.
const Scenarios& archive_scenarios();
const Scenarios& choosing_scenarios();
const Scenarios& contour_scenarios();
const Scenarios& correct_scenarios();
const Scenarios& correct_state_scenarios();
const Scenarios& device_scenarios();
const Scenarios& felt_trace_scenarios();
const Scenarios& frame_scenarios();
const Scenarios& hand_scenarios();
const Scenarios& heap_scenarios();
const Scenarios& interchange_scenarios();
const Scenarios& language_scenarios();
const Scenarios& layout_scenarios();
const Scenarios& look_scenarios();
const Scenarios& legible_scenarios();
const Scenarios& mark_scenarios();
const Scenarios& measured_scenarios();
const Scenarios& picture_scenarios();
const Scenarios& profile_scenarios();
const Scenarios& recording_scenarios();
const Scenarios& remote_scenarios();
const Scenarios& sent_mark_scenarios();
const Scenarios& sharing_scenarios();
const Scenarios& overtaken_scenarios();
const Scenarios& shown_scenarios();
const Scenarios& slice_scenarios();
const Scenarios& story_scenarios();
const Scenarios& structure_scenarios();
const Scenarios& reading_scenarios();
const Scenarios& tuning_scenarios();
const Scenarios& unsaved_scenarios();
const Scenarios& volume_drawing_scenarios();
const Scenarios& volume_scenarios();

/// The ray caster of the volume, used without a graphics card; throws if it is not ours.
palpate::plugin::Caster& caster_of_the_volume();
/// The scan's reader in the pipeline; throws if there is none.
pqPipelineSource& reader();
/// The reader's number, unique for each reader; 0 if there is none.
unsigned reader_in_pipeline();
/// Chooses a row of the list of series, and waits until its scan is shown.
void choose_series(int row);
/// The same with unsaved work, answering the question with this button: "Save", "Discard" or "Cancel". Does not wait.
void choose_series_and(int row, const char* answer);
/// Answers the question about unsaved work with that button. Returns the text of the question.
QString answer(QDialog& question, const char* button);
/// Reads a state file as File > Load State does, and waits until another scan is shown.
void load_state(const QString& file);
int views_open();
/// Expects one reader, one scene, one tab, and four views that show the scan.
void expect_four_views_of_one_scan();
/// The JSON text of the scene in the pipeline; empty if there is none.
std::string scene_text();
/// The same once it is steady: no edit is pending.
std::string steady_scene();
/// The text of the marks in the pipeline, with those of all scans.
std::string marks_text();
/// Waits until the scan and its tissues are shown, and the views rest.
void scan_is_shown();
/// The same if a scan is already shown: waits for one whose reader is not `before`.
void another_scan_is_shown(unsigned before);
/// The panel's own session.
palpate::plugin::SessionController& panel_session();
/// Connects, and turns the forces on.
void connect_stylus();
/// Turns the forces on, after clearing a fault if there is one.
void turn_forces_on();
bool forces_are_on();
/// Waits until the stylus has kept its place for a tenth of a second of session time.
void stylus_rests();
/// One step of the hand, by a key in a view: returns when the hand's target has changed.
void step_hand(QWidget& in, const char* key);
/// Blocks the program, without handling events, until the servo notices it.
void hang();
/// The servo's clock in a scenario. Its ticks are never late, and time stops while the program is too busy to show that
/// it is alive, except in hang() and if it is `left_alone`.
std::unique_ptr<palpate::plugin::ServoClock> panel_clock(double period_s, bool left_alone);
/// Presses slowly from the front until something is felt; the button stays down.
void press();
/// The same, then releases; by the view's own events instead of the slower display's pointer.
void press_once();
/// Waits for the scan, connects the stylus, and presses.
void feel();
/// Drops a folder on the panel.
void drop_folder(const QString& folder);
