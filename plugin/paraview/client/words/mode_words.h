#pragma once

/// What a mode of the scene is called and which color it has, for people.

#include <QColor>
#include <QString>

#include "modes/scene/scene.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {

inline QString name_of(const modes::Scene& scene, std::size_t mode) {
  return QString::fromStdString(display_name(scene, mode));
}

/// Gray where it has none.
inline QColor color_of(const modes::Mode& mode) {
  return mode.color.empty() ? QColor(128, 128, 128) : QColor(QString::fromStdString(mode.color));
}

}  // namespace palpate::plugin
