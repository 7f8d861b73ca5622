#include "plugin/paraview/client/words/scan_identity.h"

#include <QCoreApplication>
#include <QDate>
#include <QStringList>

namespace palpate::plugin {
namespace {

/// "DOE, JANE ANN" of DICOM's "DOE^JANE^ANN^^". Of a name that is written in several alphabets the first.
QString person(const std::string& name) {
  QStringList parts;
  for (const QString& part : QString::fromStdString(name).section('=', 0, 0).split('^')) {
    if (!part.trimmed().isEmpty()) parts << part.trimmed();
  }
  if (parts.size() < 2) return parts.join(QString());
  const QString family = parts.takeFirst();
  return QStringLiteral("%1, %2").arg(family, parts.join(QLatin1Char(' ')));
}

}  // namespace

QString identity_text(const io::Series& series) {
  const auto utf8 = [](const std::string& text) { return QString::fromStdString(text); };
  QStringList lines{person(series.identity.patient_name)};
  if (!series.identity.patient_id.empty()) {
    lines << QCoreApplication::translate("ScanIdentity", "ID %1").arg(utf8(series.identity.patient_id));
  }
  const QString description = utf8(series.description);
  lines << (series.details.number ? QStringLiteral("%1: %2").arg(*series.details.number).arg(description)
                                  : description);
  const QDate date = QDate::fromString(utf8(series.identity.study_date), QStringLiteral("yyyyMMdd"));
  lines << (date.isValid() ? date.toString(Qt::ISODate) : utf8(series.identity.study_date));
  lines.removeAll(QString());
  // The number of letters that fit beside the letter in the middle of the view's upper edge.
  constexpr int most = 24;
  for (QString& line : lines) {
    if (line.size() > most) line = line.left(most - 1) + QChar(0x2026);
  }
  return lines.join(QLatin1Char('\n'));
}

}  // namespace palpate::plugin
