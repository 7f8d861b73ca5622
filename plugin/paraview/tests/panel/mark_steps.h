#pragma once

/// Steps of the scenarios with marks: making and finding them.

#include <QString>
#include <QTreeWidget>

#include <string>
#include <vector>

#include "plugin/recording/marks.h"

/// The panel's list of marks.
QTreeWidget& mark_list();
/// Waits until the list has so many rows.
void has_rows(int count, const std::string& what);
/// Chooses these rows and no others.
void choose_marks(const std::vector<int>& rows);
/// The marks of the one scan that has any.
palpate::plugin::Marks kept_marks();
/// A file beside the pictures of the run.
QString beside_pictures(const char* name);

/// Goes into the surface from the front, by keys; the hand stays at its last position.
void touch_surface();
/// Presses a key in the coronal view this many times.
void step(const char* key, int times);
void mark_by_key();
/// Lifts the stylus, moves it sideways and touches again.
void go_to(const char* key, int times);
/// Three marks on the surface: two by the key, one by the button.
void mark_three();
