#pragma once

/// A language in which every translated text begins with a mark. A text without the mark is not translated.

#include <QCoreApplication>
#include <QTranslator>

#include "plugin/paraview/client/model/testing/application.h"

namespace palpate::plugin::testing {

/// Used while this object exists.
class MarkingTranslator : public QTranslator {
 public:
  static constexpr char mark = '#';
  MarkingTranslator() {
    application();
    QCoreApplication::installTranslator(this);
  }
  ~MarkingTranslator() override { QCoreApplication::removeTranslator(this); }
  bool isEmpty() const override { return false; }
  QString translate(const char* /*context*/, const char* text, const char* /*which*/, int /*n*/) const override {
    return QLatin1Char(mark) + QString::fromUtf8(text);
  }
};

inline bool is_translated(const QString& text) {
  return text.startsWith(QLatin1Char(MarkingTranslator::mark));
}

}  // namespace palpate::plugin::testing
