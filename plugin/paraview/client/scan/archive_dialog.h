#pragma once

/// The dialog to enter an archive: its address, its AE title and ours.

#include <QDialog>

#include "io/archive/archive.h"
#include "plugin/paraview/client/jobs/job.h"

class QCheckBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QSpinBox;

namespace palpate::plugin {

/// The time that an archive took to answer an echo, ms. Throws as io::echo() does.
double echo_ms(const io::Archive& archive);

class ArchiveDialog : public QDialog {
  Q_OBJECT

 public:
  /// `echoing` outlives the dialog, so an archive that does not answer does not delay closing.
  ArchiveDialog(Job& echoing, QWidget* parent);
  ~ArchiveDialog() override;

  /// The name of the entered archive.
  QString name() const;

 public slots:
  /// Writes the archive to the settings. If that fails, the dialog stays open and says why.
  void accept() override;

 private:
  void build_tls(QFormLayout& form);
  void show_tls();
  io::Tls tls() const;
  io::Archive archive() const;
  void echo();
  void tell(const QString& message, bool problem);

  QLineEdit* name_;
  QLineEdit* host_;
  QSpinBox* port_;
  QLineEdit* called_;
  QLineEdit* calling_;
  QCheckBox* uses_get_;
  QSpinBox* listen_;
  QLineEdit* authorities_ = nullptr;
  QLineEdit* certificate_ = nullptr;
  QLineEdit* key_ = nullptr;
  QLineEdit* tls_name_ = nullptr;
  QLabel* message_;
  Job& echoing_;
};

}  // namespace palpate::plugin
