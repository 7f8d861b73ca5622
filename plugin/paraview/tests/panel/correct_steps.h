#pragma once

/// Shared by the scenarios that correct a phantom's ball, whose outline lacks a cap in front.

#include <QColor>
#include <QPoint>
#include <QTreeWidget>
#include <QWidget>

#include <glm/vec3.hpp>
#include <vector>

#include "io/structures/edit.h"

constexpr double ball_mm = 25, cut_mm = 4;  // of the phantom, and how deep its outline's cap is cut off

/// The pixel of a view that shows a place of the patient.
QPoint pixel_of(const char* name, const glm::dvec3& place);
/// The list of doubtful places.
QTreeWidget& places();
QColor color_of_liver();
/// The outline's distance at a place, from the session's field; NaN if none is felt.
double felt_mm(const glm::dvec3& place);
/// The largest distance of a line of that width from the felt surface, mm; NaN if there is no line.
double drawn_beside_felt(double pixels);
/// A point on the ball's front edge, this many degrees to the left, on an axial slice of that height.
glm::dvec3 on_the_edge(double degrees, double height_mm);
/// The position of the axial slice.
double height_of_slice();
bool has_edit(const char* kind);
/// Of the first structure of the scene.
std::vector<palpate::io::Edit> edits_in_scene();
/// Waits until so many structures are found and measured.
void structures_are_listed(int count);
/// Unfolds the structures' section, and presses *Correct* for its only structure.
void correct_the_liver();
/// Moves the pointer along the ball's edge over the cut cap, with the button held.
void trace_the_edge(double height_mm);
/// Opens a study with a segmentation whose cap is cut off, and corrects a first edge: returns the middle of the trace.
glm::dvec3 cap_is_traced();
