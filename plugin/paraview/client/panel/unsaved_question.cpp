#include "plugin/paraview/client/panel/unsaved_question.h"

#include <QCoreApplication>
#include <QMessageBox>
#include <QPushButton>
#include <QStringList>

#include <string>

namespace palpate::plugin {
namespace {

struct UnsavedQuestion {
  Q_DECLARE_TR_FUNCTIONS(UnsavedQuestion)
};

}  // namespace

QString in_words(const Unsaved& unsaved) {
  QStringList parts;
  if (unsaved.scene) parts << UnsavedQuestion::tr("the edited scene");
  for (const std::string& name : unsaved.outlines) {
    parts << UnsavedQuestion::tr("the corrected outline of %1").arg(QString::fromStdString(name));
  }
  if (unsaved.marks > 0) {
    parts << (unsaved.marks == 1 ? UnsavedQuestion::tr("1 mark") : UnsavedQuestion::tr("%1 marks").arg(unsaved.marks));
  }
  return parts.join(QStringLiteral(", "));
}

UnsavedAnswer ask_what_becomes_of(const Unsaved& unsaved, const QString& before, QWidget* parent) {
  QMessageBox box(QMessageBox::Warning, UnsavedQuestion::tr("Not saved"),
                  UnsavedQuestion::tr("%1 Not saved: %2.").arg(before, in_words(unsaved)), QMessageBox::NoButton,
                  parent);
  box.setObjectName(QStringLiteral("palpateUnsaved"));
  box.setInformativeText(
      UnsavedQuestion::tr("Save writes all that is open to a state file. File > Load State opens it again."));
  QPushButton* const save = box.addButton(UnsavedQuestion::tr("Save…"), QMessageBox::AcceptRole);
  QPushButton* const discard = box.addButton(UnsavedQuestion::tr("Discard"), QMessageBox::DestructiveRole);
  QPushButton* const cancel = box.addButton(UnsavedQuestion::tr("Cancel"), QMessageBox::RejectRole);
  save->setObjectName(QStringLiteral("palpateUnsavedSave"));
  discard->setObjectName(QStringLiteral("palpateUnsavedDiscard"));
  cancel->setObjectName(QStringLiteral("palpateUnsavedCancel"));
  box.setDefaultButton(save);
  box.setEscapeButton(cancel);
  box.exec();
  if (box.clickedButton() == save) return UnsavedAnswer::save;
  return box.clickedButton() == discard ? UnsavedAnswer::discard : UnsavedAnswer::cancel;
}

}  // namespace palpate::plugin
