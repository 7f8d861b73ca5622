#pragma once

/// What most scenarios begin with.

#include <QString>

#include <map>
#include <string>

class pqPipelineSource;

/// A scenario by its name.
using Scenarios = std::map<std::string, void (*)()>;

/// Of the files of that name.
const Scenarios& archive_scenarios();
const Scenarios& choosing_scenarios();
const Scenarios& contour_scenarios();
const Scenarios& device_scenarios();
const Scenarios& frame_scenarios();
const Scenarios& hand_scenarios();
const Scenarios& heap_scenarios();
const Scenarios& interchange_scenarios();
const Scenarios& language_scenarios();
const Scenarios& layout_scenarios();
const Scenarios& mark_scenarios();
const Scenarios& picture_scenarios();
const Scenarios& profile_scenarios();
const Scenarios& recording_scenarios();
const Scenarios& remote_scenarios();
const Scenarios& sent_mark_scenarios();
const Scenarios& shown_scenarios();
const Scenarios& slice_scenarios();
const Scenarios& story_scenarios();
const Scenarios& structure_scenarios();
const Scenarios& reading_scenarios();
const Scenarios& tuning_scenarios();
const Scenarios& volume_scenarios();

/// The scan's reader in the pipeline; throws where there is none.
pqPipelineSource& reader();
/// Its number, which is another for each reader; 0 where there is none.
unsigned reader_in_pipeline();
/// Chooses a row of the list of series, and waits until that scan is shown.
void choose_series(int row);
/// The JSON text of the scene in the pipeline; empty where there is none.
std::string scene_text();
/// The marks' text in the pipeline, which holds those of all scans.
std::string marks_text();
/// Waits for the scan and its tissues.
void scan_is_shown();
/// Connects, and turns the forces on.
void connect_stylus();
/// Feel, after a fault is cleared where there is one.
void turn_forces_on();
bool forces_are_on();
/// Presses from the front, slowly, until something is felt; the button stays down.
void press();
/// The same, and lets go, by the view's own events instead of the display's pointer, which takes long; once more where
/// a busy machine's servo has taken the force away meanwhile.
void press_once();
/// Waits for the scan, connects, and presses.
void feel();
/// Drops a folder on the panel.
void drop_folder(const QString& folder);
