#include "plugin/paraview/client/words/series_words.h"

#include <QCoreApplication>
#include <QStringList>

#include "io/choose_first.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/client/words/patient_words.h"

namespace palpate::plugin {
namespace {

QString translated(const char* text) {
  return QCoreApplication::translate("SeriesWords", text);
}

QString slices_of(const io::Series& series) {
  const io::Series::Details& details = series.details;
  const double apart = series.geometry.slice_spacing();
  QStringList words;
  if (details.thickness_mm > 0) words << translated("%1 mm thick").arg(details.thickness_mm, 0, 'g', 3);
  if (series.geometry.dimensions.z > 1) words << translated("every %1 mm").arg(apart, 0, 'g', 3);
  return words.join(QStringLiteral(", "));
}

}  // namespace

QString series_title(const io::Series& series) {
  const QString description = QString::fromStdString(series.description);
  const QString name = description.isEmpty() ? translated("without a description") : description;
  return series.details.number ? QStringLiteral("%1  %2").arg(*series.details.number).arg(name) : name;
}

QString series_details(const io::Series& series) {
  const io::Series::Details& details = series.details;
  const auto named = [](const char* what, const std::string& value) {
    return value.empty() ? QString() : translated(what).arg(QString::fromStdString(value));
  };
  const int slices = series.geometry.dimensions.z;
  QStringList words{
      (date_in_words(details.date) + QLatin1Char(' ') + time_in_words(details.time)).trimmed(),
      QString::fromStdString(details.body_part),
      QString::fromStdString(details.orientation),
      named("kernel %1", details.kernel),
      named("sequence %1", details.sequence),
      named("contrast %1", details.contrast),
      slices_of(series),
      slices == 1  ? translated("1 slice")
      : slices > 1 ? translated("%1 slices").arg(slices)
                   : QString(),
      series.frames_per_position > 1 ? translated("%1 frames").arg(series.frames_per_position) : QString()};
  words.removeAll(QString());
  return words.join(QStringLiteral(" · "));
}

QString why_first(const io::Series& series) {
  QStringList words{translated("slices every %1 mm").arg(series.geometry.slice_spacing(), 0, 'f', 2)};
  if (const std::string& kernel = series.details.kernel; !kernel.empty()) {
    words
        << translated(io::is_sharp(kernel) ? "sharp kernel %1" : "soft kernel %1").arg(QString::fromStdString(kernel));
  }
  words << translated("%1 slices").arg(series.geometry.dimensions.z);
  return words.join(QStringLiteral(", "));
}

QString why_not_usable(const io::Series& series) {
  if (series.usable) return {};
  return series.warnings.empty() ? translated("not a volume") : words(series.warnings.front());
}

}  // namespace palpate::plugin
