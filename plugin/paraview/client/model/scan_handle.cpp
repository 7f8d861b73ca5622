#include "plugin/paraview/client/model/scan_handle.h"

#include <QCoreApplication>

#include <glm/geometric.hpp>
#include <utility>

#include "io/fields/filtered.h"
#include "modes/scene/starting_scene.h"
#include "plugin/app/scan_choice.h"

namespace palpate::plugin {

const io::Series* SeriesRef::details() const {
  return catalogue ? &scan_at(*catalogue, series) : nullptr;
}

QString ScanHandle::frame_in_words(int of_frame) const {
  if (frames <= 1) return {};
  const auto n = static_cast<std::size_t>(of_frame);
  const QString name = n < frame_names.size() ? QString::fromStdString(frame_names[n]) : QString();
  const QString meaning = name.isEmpty() ? QCoreApplication::translate("ScanHandle", "frame") : name;
  return QCoreApplication::translate("ScanHandle", name.isEmpty() ? "%1 %2 of %3" : "%1, %2 of %3")
      .arg(meaning)
      .arg(of_frame + 1)
      .arg(frames);
}

QString ScanHandle::in_words() const {
  return frames > 1 ? QStringLiteral("%1, %2").arg(series, frame_in_words()) : series;
}

QString size_in_words(const io::Volume& volume) {
  const io::Geometry& geometry = volume.geometry;
  const io::Filter filter = io::filter_of(volume);
  const QString size = QCoreApplication::translate("ScanHandle", "%1, %2 slices of %3 x %4, every %5 mm")
                           .arg(QString::fromStdString(volume.modality))
                           .arg(geometry.dimensions.z)
                           .arg(geometry.dimensions.x)
                           .arg(geometry.dimensions.y)
                           .arg(QString::number(glm::length(geometry.step), 'g', 3));
  return filter.type == nullptr ? size : size + QStringLiteral(", ") + QString::fromStdString(io::in_words(filter));
}

ScanHandle handle_of(const SeriesRef& of, std::shared_ptr<const io::Volume> volume, int frame, int frames) {
  ScanHandle handle{.of = of, .volume = std::move(volume), .frame = frame, .frames = frames};
  handle.scene = modes::starting_scene(*handle.volume);
  if (const io::Series* const series = of.details()) {
    handle.series = QString::fromStdString(scan_label(*series));
    handle.frames = series->frames_per_position;
    handle.frame_names = series->frame_names;
  } else {
    handle.series = size_in_words(*handle.volume);
  }
  return handle;
}

}  // namespace palpate::plugin
