#include "plugin/paraview/client/layout/start_page.h"

#include <QDragEnterEvent>
#include <QDropEvent>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QMimeData>
#include <QPushButton>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "io/choose_first.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/client/layout/series_card.h"
#include "plugin/paraview/client/scan/recent_folders.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/words/patient_words.h"
#include "plugin/paraview/client/words/series_words.h"

namespace palpate::plugin {
namespace {

QLabel* heading(const QString& text, const char* style) {
  auto* const label = new QLabel(text);
  label->setTextFormat(Qt::PlainText);
  label->setStyleSheet(QString::fromLatin1(style));
  label->setWordWrap(true);
  return label;
}

auto patient_of(const io::Series& series) {
  return std::pair(series.identity.patient_name, series.identity.patient_id);
}

/// Grouped by patient, then by study; otherwise in the given order.
std::vector<std::size_t> by_patient_and_study(const std::vector<const io::Series*>& all) {
  std::map<std::pair<std::string, std::string>, std::size_t> patients;
  std::map<std::string, std::size_t> studies;
  std::vector<std::size_t> order;
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (std::size_t n = 0; n < all.size(); ++n) {
    order.push_back(n);
    places.emplace_back(patients.emplace(patient_of(*all[n]), n).first->second,
                        studies.emplace(all[n]->study_uid, n).first->second);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t n) { return places[n]; });
  return order;
}

}  // namespace

StartPage::StartPage(QWidget* parent) : QScrollArea(parent) {
  setObjectName(QStringLiteral("palpateStart"));
  viewport()->setAcceptDrops(true);  // else ParaView's window takes what is dropped
  setWidgetResizable(true);
  setFrameShape(QFrame::NoFrame);
  auto* const content = new QWidget;
  column_ = new QVBoxLayout(content);
  constexpr int margin = 18;
  column_->setContentsMargins(margin, margin, margin, margin);
  column_->addWidget(build_ways());
  message_ = heading({}, "");
  message_->setObjectName(QStringLiteral("palpateStartMessage"));
  column_->addWidget(message_);
  recent_ = new QWidget;
  recent_->setObjectName(QStringLiteral("palpateStartRecent"));
  new QVBoxLayout(recent_);
  recent_->layout()->setContentsMargins(0, 0, 0, 0);
  column_->addWidget(recent_);
  column_->addStretch(1);
  setWidget(content);
  tell({});
  refresh_recent();
}

QWidget* StartPage::build_ways() {
  auto* const ways = new QFrame;
  ways->setObjectName(QStringLiteral("palpateStartWays"));
  ways->setStyleSheet(QStringLiteral("#palpateStartWays { border: 2px dashed palette(mid); border-radius: 8px }"));
  auto* const column = new QVBoxLayout(ways);
  QLabel* const drop = heading(tr("Drop a DICOM folder here"), "font-size: 18px");
  drop->setAlignment(Qt::AlignCenter);
  column->addWidget(drop);
  QLabel* const others = heading(tr("or a scan in NIfTI, NRRD or MetaImage, or a zipped study"), "");
  others->setAlignment(Qt::AlignCenter);
  column->addWidget(others);
  auto* const row = new QHBoxLayout;
  row->addStretch(1);
  const auto add = [&](const char* name, const QString& text, auto signal) {
    auto* const button = new QPushButton(text);
    button->setObjectName(QString::fromLatin1(name));
    constexpr int tall = 32;
    button->setMinimumHeight(tall);
    connect(button, &QPushButton::clicked, this, signal);
    row->addWidget(button);
    return button;
  };
  add("palpateStartOpen", tr("Open a DICOM folder…"), &StartPage::open_wanted);
  add("palpateStartArchive", tr("Search an archive"), &StartPage::archive_wanted);
  sample_ = add("palpateStartSample", QString(), &StartPage::sample_wanted);
  sample_->hide();
  row->addStretch(1);
  column->addLayout(row);
  return ways;
}

void StartPage::tell(const QString& message, bool problem) {
  show_message(*message_, message, problem);
}

void StartPage::set_sample(const QString& offer) {
  sample_->setText(offer);
  sample_->setVisible(!offer.isEmpty());
}

void StartPage::refresh_recent() {
  qDeleteAll(recent_->findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly));
  const QStringList folders = recent_folders();
  if (folders.isEmpty()) return;
  recent_->layout()->addWidget(heading(tr("Recently opened"), "font-size: 15px; font-weight: bold"));
  for (const QString& folder : folders) {
    auto* const button = new QPushButton(folder);
    button->setObjectName(QStringLiteral("palpateStartFolder"));
    button->setFlat(true);
    button->setStyleSheet(QStringLiteral("text-align: left; padding: 4px"));
    connect(button, &QPushButton::clicked, this, [this, folder] { emit folder_wanted(folder); });
    recent_->layout()->addWidget(button);
  }
}

void StartPage::set_catalogue(const std::shared_ptr<const io::Catalogue>& catalogue) {
  delete patients_;
  patients_ = nullptr;
  studies_.clear();
  cards_.clear();
  across_ = 0;
  recent_->setVisible(!catalogue);
  refresh_recent();
  if (!catalogue || catalogue->series.empty()) return;
  patients_ = new QWidget;
  patients_->setObjectName(QStringLiteral("palpateStartPatients"));
  (new QVBoxLayout(patients_))->setContentsMargins(0, 0, 0, 0);
  column_->insertWidget(column_->count() - 1, patients_);
  std::vector<const io::Series*> all;
  for (std::size_t n = 0; n < scan_count(*catalogue); ++n) all.push_back(&scan_at(*catalogue, n));
  const auto first = io::choose_first(catalogue->series);
  cards_.resize(all.size());
  const io::Series* last = nullptr;
  for (const std::size_t n : by_patient_and_study(all)) {
    const bool same_patient = last && patient_of(*last) == patient_of(*all[n]);
    if (!same_patient) add_patient(*all[n]);
    if (!same_patient || last->study_uid != all[n]->study_uid) add_study(*all[n]);
    last = all[n];
    const QString best = first && first->index == n ? why_first(*all[n]) : QString();
    auto* const card = new SeriesCard(*all[n], best, patients_);
    connect(card, &QPushButton::clicked, this, [this, n] { emit series_wanted(n); });
    studies_.back().series.push_back(card);
    cards_[n] = card;
  }
  place_cards();
}

void StartPage::add_patient(const io::Series& of) {
  QString who = patient_in_words(of.identity.patient_name);
  if (who.isEmpty()) who = tr("A patient without a name");
  if (!of.identity.patient_id.empty()) who += tr("   ID %1").arg(QString::fromStdString(of.identity.patient_id));
  QLabel* const label = heading(who, "font-size: 17px; font-weight: bold");
  label->setObjectName(QStringLiteral("palpateStartPatient"));
  patients_->layout()->addWidget(label);
}

void StartPage::add_study(const io::Series& of) {
  const QString date = date_in_words(of.identity.study_date);
  QLabel* const label =
      heading(date.isEmpty() ? tr("Study without a date") : tr("Study of %1").arg(date), "font-size: 14px");
  label->setObjectName(QStringLiteral("palpateStartStudy"));
  patients_->layout()->addWidget(label);
  auto* const cards = new QGridLayout;
  static_cast<QVBoxLayout*>(patients_->layout())->addLayout(cards);
  studies_.push_back({cards, {}});
}

/// As many beside each other as there is room for.
void StartPage::place_cards() {
  constexpr int card_width = 400;
  const int across = std::max(1, viewport()->width() / card_width);
  if (across == across_) return;
  across_ = across;
  for (const Study& study : studies_) {
    for (int n = 0; n < static_cast<int>(study.series.size()); ++n) {
      study.cards->addWidget(study.series[static_cast<std::size_t>(n)], n / across, n % across);
    }
    constexpr int most = 12;
    for (int n = 0; n < most; ++n) study.cards->setColumnStretch(n, n < across ? 1 : 0);
  }
}

void StartPage::set_picture(std::size_t series, const QImage& picture) {
  if (series < cards_.size() && cards_[series]) cards_[series]->set_picture(picture);
}

void StartPage::resizeEvent(QResizeEvent* event) {
  QScrollArea::resizeEvent(event);
  place_cards();
}

void StartPage::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls() && event->mimeData()->urls().first().isLocalFile()) event->acceptProposedAction();
}

void StartPage::dropEvent(QDropEvent* event) {
  event->acceptProposedAction();
  emit folder_wanted(event->mimeData()->urls().first().toLocalFile());
}

}  // namespace palpate::plugin
