#include "plugin/paraview/client/language/translation.h"

#include <QCoreApplication>
#include <QLocale>
#include <QSettings>
#include <QStringList>

#include <string_view>

namespace palpate::plugin {

Translation::Translation() {
  const QString chosen = QSettings().value(QStringLiteral("palpate/language")).toString();
  for (const QString& language : chosen.isEmpty() ? QLocale::system().uiLanguages() : QStringList{chosen}) {
    const QString name = language.left(2).toLower();
    if (name == QLatin1String("en")) return;  // the texts' own
    if (!load(QStringLiteral(":/palpate/palpate_%1.qm").arg(name))) continue;
    QCoreApplication::installTranslator(this);
    return;
  }
}

Translation::~Translation() {
  QCoreApplication::removeTranslator(this);
}

/// Qt's tools know the class that a text is in without the namespace, which the program asks with.
QString Translation::translate(const char* context, const char* text, const char* about, int count) const {
  constexpr std::string_view ours = "palpate::plugin::";
  const std::string_view whole = context ? context : "";
  return QTranslator::translate(whole.starts_with(ours) ? context + ours.size() : context, text, about, count);
}

}  // namespace palpate::plugin
