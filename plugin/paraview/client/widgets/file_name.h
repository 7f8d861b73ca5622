#pragma once

/// Asks for a file that is to be written, and tells if it could not be.

#include <QCoreApplication>
#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QString>
#include <QWidget>

namespace palpate::plugin {

/// `title` of the dialog; `filter` as in "Pictures (*.png)"; `suffix`: that the file gets where it has none;
/// `proposed`: a name or nothing. Empty if the user changes their mind.
inline QString ask_file_to_write(QWidget* parent, const QString& title, const QString& filter, const QString& suffix,
                                 const QString& proposed = {}) {
  QFileDialog dialog(parent, title, {}, filter);
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(suffix);
  dialog.selectFile(proposed);
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return {};
  QString file = dialog.selectedFiles().first();
  if (!QFileInfo(file).suffix().isEmpty()) return file;
  // Qt 5 adds the suffix only where no dot is in the whole path, as there is in the folder "study 1.2", and has not
  // asked of this file.
  const QString whole = file + QLatin1Char('.') + suffix;
  const bool taken =
      QFileInfo::exists(whole) &&
      QMessageBox::question(parent, title,
                            QCoreApplication::translate("FileName", "%1 is there already. Replace it?").arg(whole)) !=
          QMessageBox::Yes;
  return taken ? QString() : whole;
}

/// In front of what asked for the file.
inline void tell_not_written(QWidget* parent, const QString& title, const QString& why) {
  QMessageBox box(QMessageBox::Warning, title, why, QMessageBox::Ok, parent);
  box.setObjectName(QStringLiteral("palpateNotWritten"));
  box.setTextFormat(Qt::PlainText);
  box.exec();
}

}  // namespace palpate::plugin
