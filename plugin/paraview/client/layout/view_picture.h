#pragma once

/// A picture of what the views show.

#include <QString>

class pqRenderView;

namespace palpate::plugin {

/// As a PNG file: the view alone where it is enlarged, else all views of its tab; without the patient's name and the
/// scroll bars. Whether it was written.
bool save_picture(pqRenderView& marked, const QString& file);

}  // namespace palpate::plugin
