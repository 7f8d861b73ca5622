#include "plugin/paraview/client/words/archive_date.h"

#include <QRegularExpression>

namespace palpate::plugin {

std::optional<std::string> archive_date(const QString& typed) {
  static const QRegularExpression year(QStringLiteral("^\\d{4}$"));
  static const QRegularExpression month(QStringLiteral("^(\\d{4})-?(\\d{2})$"));
  static const QRegularExpression day(QStringLiteral("^(\\d{4})-(\\d{2})-(\\d{2})$"));
  static const QRegularExpression span(QStringLiteral("^(\\d{8}|\\d{8}-|-\\d{8}|\\d{8}-\\d{8})$"));
  const QString text = typed.trimmed();
  if (text.isEmpty()) return std::string();
  if (year.match(text).hasMatch())
    return (text + QStringLiteral("0101-") + text + QStringLiteral("1231")).toStdString();
  if (const auto found = month.match(text); found.hasMatch()) {
    return (found.captured(1) + found.captured(2) + QStringLiteral("01-") + found.captured(1) + found.captured(2) +
            QStringLiteral("31"))
        .toStdString();
  }
  if (const auto found = day.match(text); found.hasMatch()) {
    return (found.captured(1) + found.captured(2) + found.captured(3)).toStdString();
  }
  if (span.match(text).hasMatch()) return text.toStdString();
  return std::nullopt;
}

}  // namespace palpate::plugin
