#include "plugin/paraview/client/scan/scan_handle.h"

#include <QCoreApplication>

namespace palpate::plugin {

QString ScanHandle::frame_in_words(int of) const {
  if (frames <= 1) return {};
  const auto n = static_cast<std::size_t>(of);
  const QString name = n < frame_names.size() ? QString::fromStdString(frame_names[n]) : QString();
  const QString meaning = name.isEmpty() ? QCoreApplication::translate("ScanHandle", "frame") : name;
  return QCoreApplication::translate("ScanHandle", name.isEmpty() ? "%1 %2 of %3" : "%1, %2 of %3")
      .arg(meaning)
      .arg(of + 1)
      .arg(frames);
}

QString ScanHandle::in_words() const {
  return frames > 1 ? QStringLiteral("%1, %2").arg(series, frame_in_words()) : series;
}

}  // namespace palpate::plugin
