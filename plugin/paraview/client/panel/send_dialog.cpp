#include "plugin/paraview/client/panel/send_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QLabel>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QStringList>

#include <utility>

#include "plugin/paraview/client/words/patient_words.h"
#include "plugin/report/mark_results.h"

namespace palpate::plugin {
namespace {

QString joined(QStringList parts) {
  parts.removeAll(QString());
  return parts.join(QStringLiteral("  ·  "));
}

}  // namespace

SendDialog::Content SendDialog::of_marks(const io::Series& series, const Marks& marks) {
  return {.title = tr("Send marks"),
          .what = tr("A report (SR) of %1 marks, %2 distances and %3 paths, and %4 pictures of the marks")
                      .arg(marks.points.size())
                      .arg(marks.distances.size())
                      .arg(marks.paths.size())
                      .arg(marks.points.size()),
          .report = QString::fromStdString(
              report_in_words(report_of(marks), series.modality == "CT" ? std::string("HU") : std::string())),
          .note = tr("They go into this study. The report says that research software, not a medical device, made it. "
                     "The pictures show the scan and no name.")};
}

SendDialog::Content SendDialog::of_outline(const QString& structure, const QString& change) {
  return {.title = tr("Send the corrected outline"),
          .what = tr("A segmentation (SEG) of %1. %2").arg(structure, change),
          .report = {},
          .note = tr("It goes into this study as a new series, made with research software, not a medical device. The "
                     "original outline is not changed.")};
}

SendDialog::SendDialog(const io::Series& series, const Content& content, std::vector<io::Archive> archives,
                       QWidget* parent)
    : QDialog(parent), entered_(std::move(archives)), archives_(new QComboBox(this)) {
  setObjectName(QStringLiteral("palpateSendDialog"));
  setWindowTitle(content.title);
  auto* const form = new QFormLayout(this);
  const auto line = [&](const char* name, const QString& what, const QString& text) {
    auto* const field = new QLabel(text, this);
    field->setObjectName(QString::fromLatin1(name));
    field->setTextFormat(Qt::PlainText);
    field->setWordWrap(true);
    form->addRow(what, field);
  };
  line("palpateSendPatient", tr("Patient"),
       joined({patient_in_words(series.identity.patient_name), QString::fromStdString(series.identity.patient_id)}));
  line("palpateSendStudy", tr("Study"),
       joined({date_in_words(series.identity.study_date), QString::fromStdString(series.modality),
               QString::fromStdString(series.description)}));
  line("palpateSendWhat", tr("What"), content.what);
  if (!content.report.isEmpty()) {
    auto* const report = new QPlainTextEdit(this);
    report->setObjectName(QStringLiteral("palpateSendReport"));
    report->setReadOnly(true);
    report->setLineWrapMode(QPlainTextEdit::NoWrap);
    report->setPlainText(content.report);
    form->addRow(tr("Report"), report);
  }
  archives_->setObjectName(QStringLiteral("palpateSendArchive"));
  for (const io::Archive& one : entered_) {
    archives_->addItem(QStringLiteral("%1 (%2:%3)")
                           .arg(QString::fromStdString(one.name), QString::fromStdString(one.host))
                           .arg(one.port));
  }
  form->addRow(tr("To"), archives_);
  line("palpateSendNote", QString(), content.note);
  auto* const buttons = new QDialogButtonBox(QDialogButtonBox::Cancel, this);
  QPushButton* const send = buttons->addButton(tr("Send"), QDialogButtonBox::AcceptRole);
  send->setObjectName(QStringLiteral("palpateSendOk"));
  connect(buttons, &QDialogButtonBox::accepted, this, &QDialog::accept);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  form->addRow(buttons);
  constexpr int wide = 560;
  setMinimumWidth(wide);
}

const io::Archive& SendDialog::archive() const {
  return entered_[static_cast<std::size_t>(archives_->currentIndex())];
}

}  // namespace palpate::plugin
