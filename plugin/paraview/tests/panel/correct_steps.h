#pragma once

/// A phantom's ball whose outline lacks a cap in front: what scenarios that correct it share.

#include <QColor>
#include <QPoint>
#include <QTreeWidget>
#include <QWidget>

#include <glm/vec3.hpp>
#include <vector>

#include "io/structures/edit.h"

constexpr double ball_mm = 25, cut_mm = 4;  // of the phantom, and how deep its outline's cap is cut off

/// The pixel of a view at which a place of the patient is seen.
QPoint pixel_of(const char* name, const glm::dvec3& place);
/// The list of doubtful places.
QTreeWidget& places();
QColor color_of_liver();
/// The outline's distance at a place as the session has it; NaN if none is felt.
double felt_mm(const glm::dvec3& place);
/// The farthest that a line of that width lies from where the felt distance is zero, mm; NaN if there is no line.
double drawn_beside_felt(double pixels);
/// The ball's edge in front, so many degrees to the left, on an axial slice of that height.
glm::dvec3 on_the_edge(double degrees, double height_mm);
/// Where the axial slice lies.
double height_of_slice();
bool has_edit(const char* kind);
/// Of the first structure of the scene.
std::vector<palpate::io::Edit> edits_in_scene();
/// Waits until so many structures are found and measured.
void structures_are_listed(int count);
/// The structures' section is unfolded, and *Correct* is pressed for the only one.
void correct_the_liver();
/// The pointer along the ball's edge over the cut cap, with the button held.
void trace_the_edge(double height_mm);
/// From an opened study with a segmentation whose cap was cut off to the first corrected edge: the middle of the trace.
glm::dvec3 cap_is_traced();
