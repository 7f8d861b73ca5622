#pragma once

/// The panel's texts in the user's language.

#include <QTranslator>

namespace palpate::plugin {

/// While this object exists, translated texts are shown in the language of the setting palpate/language ("de", "en"),
/// or else of the system. Untranslated texts stay English, as most messages do (plugin/docs/messages.md).
class Translation : public QTranslator {
 public:
  Translation();
  ~Translation() override;

  QString translate(const char* context, const char* text, const char* about, int count) const override;
};

}  // namespace palpate::plugin
