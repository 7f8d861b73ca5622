#pragma once

/// Asks for the name of a file to write, and reports if it could not be written.

#include <QCoreApplication>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QString>
#include <QWidget>

namespace palpate::plugin {

/// `title` of the dialog; `filter` as in "Pictures (*.png)"; `suffix`: added if the name has none; `proposed`: a name
/// or empty. Returns an empty name if the user cancels.
inline QString ask_file_to_write(QWidget* parent, const QString& title, const QString& filter, const QString& suffix,
                                 const QString& proposed = {}) {
  QFileDialog dialog(parent, title, {}, filter);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(suffix);
  dialog.selectFile(proposed);
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return {};
  QString file = dialog.selectedFiles().first();
  if (!QFileInfo(file).suffix().isEmpty()) return file;
  // Qt 5 adds the suffix only if there is no dot in the whole path, as in the folder "study 1.2", and then the dialog
  // has not asked about overwriting the file with the suffix.
  const QString whole = file + QLatin1Char('.') + suffix;
  const bool taken =
      QFileInfo::exists(whole) &&
      QMessageBox::question(parent, title,
                            QCoreApplication::translate("FileName", "%1 is there already. Replace it?").arg(whole)) !=
          QMessageBox::Yes;
  return taken ? QString() : whole;
}

/// As a dialog in front of `parent`.
inline void tell_not_written(QWidget* parent, const QString& title, const QString& why) {
  QMessageBox box(QMessageBox::Warning, title, why, QMessageBox::Ok, parent);
  box.setObjectName(QStringLiteral("palpateNotWritten"));
  box.setTextFormat(Qt::PlainText);
  box.exec();
}

}  // namespace palpate::plugin
