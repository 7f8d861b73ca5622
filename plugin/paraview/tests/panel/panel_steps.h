#pragma once

/// What most scenarios begin with.

#include <map>
#include <string>

/// A scenario by its name.
using Scenarios = std::map<std::string, void (*)()>;

/// The JSON text of the scene in the pipeline; empty where there is none.
std::string scene_text();
/// Waits for the scan and its tissues.
void scan_is_shown();
void connect_stylus();
/// Drags the stylus from the front, slowly, until something is felt; the button stays down.
void press();
/// Waits for the scan, connects and presses.
void feel();

/// Of the files of that name.
const Scenarios& profile_scenarios();
const Scenarios& recording_scenarios();
