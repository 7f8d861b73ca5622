#include "plugin/paraview/client/scan/archive_words.h"

#include <QCoreApplication>
#include <QLatin1String>
#include <QRegularExpression>

#include <algorithm>
#include <iterator>

namespace palpate::plugin {
namespace {

struct Field {
  const char* option;
  const char* context;
  const char* label;
};
constexpr Field fields[] = {
    {"--host", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "Host")},
    {"--port", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "Port")},
    {"--called", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "Its AE title")},
    {"--calling", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "Our AE title")},
    {"--get", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "Fetch with C-GET (the archive must support it)")},
    {"--listen", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "Our port")},
    {"--tls-ca", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "TLS: authority")},
    {"--tls-certificate", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "TLS: certificate")},
    {"--tls-key", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "TLS: key")},
    {"--tls-name", "ArchiveDialog", QT_TRANSLATE_NOOP("ArchiveDialog", "TLS: name")},
    {"--date", "ArchiveTab", QT_TRANSLATE_NOOP("ArchiveTab", "Date")},
    {"`palpate archive add`", "ArchiveTab", QT_TRANSLATE_NOOP("ArchiveTab", "Add…")},
};

}  // namespace

QString label_of(const QString& option) {
  const auto* const field =
      std::ranges::find_if(fields, [&](const Field& one) { return option == QLatin1String(one.option); });
  return field == std::end(fields) ? QString() : QCoreApplication::translate(field->context, field->label);
}

QString in_fields(const QString& said) {
  static const QRegularExpression option(QStringLiteral("`palpate archive add`|--[a-z][a-z0-9-]*[a-z0-9]"));
  QString text;
  int done = 0;
  for (auto found = option.globalMatch(said); found.hasNext();) {
    const QRegularExpressionMatch one = found.next();
    const QString label = label_of(one.captured());
    text += said.mid(done, one.capturedStart() - done);
    text += label.isEmpty() ? one.captured() : QStringLiteral("“%1”").arg(label);
    done = static_cast<int>(one.capturedEnd());
  }
  return text + said.mid(done);
}

}  // namespace palpate::plugin
