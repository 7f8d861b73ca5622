#pragma once

/// What most scenarios begin with.

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

/// Of the files of that name.
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
const Scenarios& legible_scenarios();
const Scenarios& mark_scenarios();
const Scenarios& picture_scenarios();
const Scenarios& profile_scenarios();
const Scenarios& recording_scenarios();
const Scenarios& remote_scenarios();
const Scenarios& sent_mark_scenarios();
const Scenarios& sharing_scenarios();
const Scenarios& shown_scenarios();
const Scenarios& slice_scenarios();
const Scenarios& story_scenarios();
const Scenarios& structure_scenarios();
const Scenarios& reading_scenarios();
const Scenarios& tuning_scenarios();
const Scenarios& unsaved_scenarios();
const Scenarios& volume_scenarios();

/// What casts the volume's rays where there is no graphics card; throws where nothing of ours does.
palpate::plugin::Caster& caster_of_the_volume();
/// The scan's reader in the pipeline; throws where there is none.
pqPipelineSource& reader();
/// Its number, which is another for each reader; 0 if there is none.
unsigned reader_in_pipeline();
/// Chooses a row of the list of series, and waits until that scan is shown.
void choose_series(int row);
/// The same where something is not saved, with the button that is pressed then: "Save", "Discard" or "Cancel". Does not
/// wait.
void choose_series_and(int row, const char* answer);
/// The question what becomes of what is not saved: presses that button in it. Returns what it asked.
QString answer(QDialog& question, const char* button);
/// Reads a state file as File > Load State does with it, and waits until another scan than now is shown.
void load_state(const QString& file);
int views_open();
/// One reader, one scene, one tab, and four views that show the scan.
void expect_four_views_of_one_scan();
/// The JSON text of the scene in the pipeline; empty if there is none.
std::string scene_text();
/// The same once it stays: no edit is on its way.
std::string steady_scene();
/// The marks' text in the pipeline, which holds those of all scans.
std::string marks_text();
/// Waits for the scan and its tissues, and until the views rest.
void scan_is_shown();
/// The same where a scan is shown already: for one whose reader is another than `before`.
void another_scan_is_shown(unsigned before);
/// The panel's own session.
palpate::plugin::SessionController& panel_session();
/// Connects, and turns the forces on.
void connect_stylus();
/// Feel, after a fault is cleared where there is one.
void turn_forces_on();
bool forces_are_on();
/// Until the stylus has kept its place for a tenth of a second of its own time, in which it ticks.
void stylus_rests();
/// One step of the hand, by a key in a view: returns once the hand wants to be elsewhere.
void step_hand(QWidget& in, const char* key);
/// The program hangs as long as it takes the servo to see it: no event is handled meanwhile.
void hang();
/// The servo's clock in a scenario: its ticks are never late, and time stands still while the program is too busy to
/// be seen alive, unless it hangs or is `left_alone`.
std::unique_ptr<palpate::plugin::ServoClock> panel_clock(double period_s, bool left_alone);
/// Presses from the front, slowly, until something is felt; the button stays down.
void press();
/// The same, and lets go, by the view's own events instead of the display's pointer, which takes long.
void press_once();
/// Waits for the scan, connects, and presses.
void feel();
/// Drops a folder on the panel.
void drop_folder(const QString& folder);
