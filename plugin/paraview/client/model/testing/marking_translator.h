#pragma once

/// A language in which every text begins with a mark: what lacks it is English for everyone.

#include <QCoreApplication>
#include <QTranslator>

#include "plugin/paraview/client/model/testing/application.h"

namespace palpate::plugin::testing {

/// It is spoken while this lives.
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
