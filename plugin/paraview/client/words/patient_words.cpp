#include "plugin/paraview/client/words/patient_words.h"

#include <QRegularExpression>
#include <QStringList>

namespace palpate::plugin {

QString patient_in_words(const std::string& name) {
  const QString whole = QString::fromStdString(name);
  const QString group = whole.section(QLatin1Char('='), 0, 0).trimmed().isEmpty()
                            ? whole.section(QLatin1Char('='), 1, 1)
                            : whole.section(QLatin1Char('='), 0, 0);
  QStringList parts = group.split(QLatin1Char('^'));
  for (QString& part : parts) part = part.trimmed();
  const QString family = parts.takeFirst();
  parts.removeAll(QString());
  const QString given = parts.join(QLatin1Char(' '));
  if (family.isEmpty() || given.isEmpty()) return family + given;
  return family + QStringLiteral(", ") + given;
}

QString date_in_words(const std::string& date) {
  static const QRegularExpression digits(QStringLiteral("^(\\d{4})\\.?(\\d{2})\\.?(\\d{2})$"));
  const auto match = digits.match(QString::fromStdString(date).trimmed());
  if (!match.hasMatch()) return QString::fromStdString(date);
  return match.captured(1) + QLatin1Char('-') + match.captured(2) + QLatin1Char('-') + match.captured(3);
}

QString time_in_words(const std::string& time) {
  static const QRegularExpression digits(QStringLiteral("^(\\d{2}):?(\\d{2})"));
  const auto match = digits.match(QString::fromStdString(time).trimmed());
  return match.hasMatch() ? match.captured(1) + QLatin1Char(':') + match.captured(2) : QString();
}

}  // namespace palpate::plugin
