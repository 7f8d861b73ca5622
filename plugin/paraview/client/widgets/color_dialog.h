#pragma once

#include <QColorDialog>

#include <functional>

namespace palpate::plugin {

/// Asks for a color, over the widget's window. Returns at once: while the dialog is open the scan may become another
/// one, and the widget may go.
inline void ask_color(const QWidget& widget, const QString& title, const QColor& now,
                      const std::function<void(const QColor&)>& chosen) {
  auto* const dialog = new QColorDialog(now, widget.window());
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setOption(QColorDialog::DontUseNativeDialog);
  dialog->setWindowTitle(title);
  QObject::connect(dialog, &QColorDialog::colorSelected, chosen);
  dialog->open();
}

}  // namespace palpate::plugin
