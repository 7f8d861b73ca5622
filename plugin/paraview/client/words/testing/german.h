#pragma once

/// The German catalogue in the sources.

#include <QFile>
#include <QString>
#include <QTranslator>
#include <QXmlStreamReader>

#include <map>
#include <utility>

#include "plugin/paraview/client/model/testing/application.h"

namespace palpate::plugin::testing {

using Catalogue = std::map<std::pair<QString, QString>, QString>;  ///< of context and English text

inline Catalogue german_catalogue() {
  Catalogue found;
  QFile file(QStringLiteral(PALPATE_SOURCES "/plugin/paraview/client/language/palpate_de.ts"));
  if (!file.open(QIODevice::ReadOnly)) return found;
  QXmlStreamReader xml(&file);
  QString context, source;
  while (!xml.atEnd()) {
    if (xml.readNext() != QXmlStreamReader::StartElement) continue;
    if (xml.name() == QLatin1String("name"))
      context = xml.readElementText();
    else if (xml.name() == QLatin1String("source"))
      source = xml.readElementText();
    else if (xml.name() == QLatin1String("translation"))
      found[{context, source}] = xml.readElementText();
  }
  return found;
}

/// Texts are German while this object exists.
class German : public QTranslator {
 public:
  German() {
    application();
    QCoreApplication::installTranslator(this);
  }
  ~German() override { QCoreApplication::removeTranslator(this); }
  bool isEmpty() const override { return false; }
  QString translate(const char* context, const char* text, const char* /*which*/, int /*n*/) const override {
    const auto found = catalogue_.find({QString::fromUtf8(context), QString::fromUtf8(text)});
    return found == catalogue_.end() ? QString() : found->second;
  }

 private:
  Catalogue catalogue_ = german_catalogue();
};

}  // namespace palpate::plugin::testing
