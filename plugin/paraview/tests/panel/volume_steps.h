#pragma once

/// What scenarios of the volume view share.

#include <QAction>

class vtkRenderer;

/// The volume view's renderer.
vtkRenderer& volume_renderer();
/// An action of the main window, by its name.
QAction& action(const char* name);
/// Whether a volume is visible in it.
bool scan_is_drawn(vtkRenderer& in);
