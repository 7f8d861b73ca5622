#pragma once

/// The displayed name and color of a mode.

#include <QColor>
#include <QString>

#include "modes/scene/scene.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {

inline QString name_of(const modes::Scene& scene, std::size_t mode) {
  return QString::fromStdString(display_name(scene, mode));
}

/// Gray if it has none.
inline QColor color_of(const modes::Mode& mode) {
  return mode.color.empty() ? QColor(128, 128, 128) : QColor(QString::fromStdString(mode.color));
}

}  // namespace palpate::plugin
