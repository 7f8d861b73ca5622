#include "plugin/paraview/client/scan/archive_search.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLineEdit>

#include "plugin/paraview/client/words/archive_date.h"

namespace palpate::plugin {

ArchiveSearch::ArchiveSearch(QWidget* parent) : QWidget(parent) {
  auto* const grid = new QGridLayout(this);
  grid->setContentsMargins(0, 0, 0, 0);
  patient_ = field("palpateFindPatient", tr("Patient"), tr("Part of the name, family name first"));
  grid->addWidget(patient_, 0, 0);
  id_ = field("palpateFindId", tr("Patient's id"), tr("The whole id; * stands for anything"));
  grid->addWidget(id_, 0, 1, 1, 2);
  description_ = field("palpateFindDescription", tr("Description"), tr("Part of the study's description"));
  grid->addWidget(description_, 1, 0);
  date_ =
      field("palpateFindDate", tr("Date"), tr("Of the study: 2026, 2026-01, 2026-01-04, or a span 20260101-20260131"));
  grid->addWidget(date_, 1, 1);
  modality_ = new QComboBox(this);
  modality_->setObjectName(QStringLiteral("palpateFindModality"));
  modality_->addItem(tr("All"));
  modality_->addItems({QStringLiteral("CT"), QStringLiteral("MR"), QStringLiteral("PT"), QStringLiteral("XA")});
  modality_->setToolTip(tr("Modality"));
  connect(modality_, QOverload<int>::of(&QComboBox::activated), this, [this] { emit wanted(false); });
  grid->addWidget(modality_, 1, 2);
  grid->setColumnStretch(0, 3);
  grid->setColumnStretch(1, 3);
  constexpr int typed_ms = 350;
  typing_.setSingleShot(true);
  typing_.setInterval(typed_ms);
  connect(&typing_, &QTimer::timeout, this, [this] { emit wanted(false); });
  connect(this, &ArchiveSearch::wanted, &typing_, &QTimer::stop);
}

QLineEdit* ArchiveSearch::field(const char* name, const QString& what, const QString& tip) {
  auto* const line = new QLineEdit(this);
  line->setObjectName(QString::fromLatin1(name));
  line->setPlaceholderText(what);
  line->setToolTip(tip);
  line->setClearButtonEnabled(true);
  connect(line, &QLineEdit::textEdited, this, [this] { typing_.start(); });
  connect(line, &QLineEdit::returnPressed, this, [this] { emit wanted(true); });
  return line;
}

std::optional<io::ArchiveQuery> ArchiveSearch::query(bool begun_date) const {
  const auto date = archive_date(date_->text());
  if (!date && !begun_date) return std::nullopt;
  io::ArchiveQuery query;
  query.patient = patient_->text().trimmed().toStdString();
  query.patient_id = id_->text().trimmed().toStdString();
  query.description = description_->text().trimmed().toStdString();
  query.date = date ? *date : date_->text().trimmed().toStdString();
  if (modality_->currentIndex() > 0) query.modality = modality_->currentText().toStdString();
  query.with_series = false;  // asked for where one looks
  return query;
}

void ArchiveSearch::focus() {
  patient_->setFocus();
}

}  // namespace palpate::plugin
