#pragma once

/// Pictures of the views.

#include <QString>

class pqRenderView;

namespace palpate::plugin {

/// Saves a PNG file: of the view alone if it is enlarged, else of all views of its tab; without the patient's name and
/// the scroll bars. Returns whether the file was written.
bool save_picture(pqRenderView& marked, const QString& file);

}  // namespace palpate::plugin
