#pragma once

#include <QColorDialog>

#include <functional>

namespace palpate::plugin {

/// Asks for a color, over the widget's window. Returns at once. While the dialog is open, another scan may be opened,
/// and the widget may be deleted.
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
