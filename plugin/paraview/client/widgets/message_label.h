#pragma once

#include <QLabel>
#include <QString>

namespace palpate::plugin {

/// A label for a section's messages, with as many lines as needed.
inline QLabel* make_message_label(QWidget& parent, const char* name) {
  auto* const label = new QLabel(&parent);
  label->setObjectName(QString::fromLatin1(name));
  label->setWordWrap(true);
  label->setTextFormat(Qt::PlainText);
  return label;
}

/// A problem is shown in bold red.
inline void set_message(QLabel& label, const QString& text, bool problem) {
  label.setText(text);
  label.setStyleSheet(problem ? QStringLiteral("color: #b00020; font-weight: bold") : QString());
}

/// The same; hides the label if the text is empty.
inline void show_message(QLabel& label, const QString& text, bool problem) {
  set_message(label, text, problem);
  label.setVisible(!text.isEmpty());
}

}  // namespace palpate::plugin
