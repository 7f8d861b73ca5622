#include "plugin/paraview/client/scan/filter_row.h"

#include <pqPipelineSource.h>
#include <pqUndoStack.h>
#include <pqView.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxy.h>
#include <vtkSMTrace.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPointer>
#include <QProgressBar>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include <memory>
#include <string>
#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/client/pipeline/scan_pipeline.h"
#include "plugin/paraview/client/widgets/message_label.h"

namespace palpate::plugin {
namespace {

constexpr double usual_sigma_mm = 1, usual_noise = 30;

/// Null for the first line of the list, "None".
const io::FilterType* type_chosen_in(const QComboBox& list) {
  return io::find_filter_type(list.currentData().toString().toStdString());
}

QString name_of(const io::FilterType* type) {
  return type == nullptr ? QString() : QString::fromStdString(std::string(type->name));
}

}  // namespace

FilterRow::FilterRow(SceneModel& model, SessionController& session, ScanModel& scans, ScanPipeline& readers,
                     QWidget* parent)
    : QWidget(parent), model_(model), session_(session), scans_(scans), readers_(readers) {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  auto* const row = new QHBoxLayout;
  row->addWidget(new QLabel(tr("Filter"), this));
  type_ = new QComboBox(this);
  type_->setObjectName(QStringLiteral("palpateFilter"));
  type_->setToolTip(
      tr("Reduces noise, which is felt as roughness. The stylus feels the filtered values. Bilateral and non-local "
         "means keep edges where they are; a Gaussian rounds them."));
  type_->addItem(tr("None"), QString());
  for (const io::FilterType* const type : io::filter_types()) type_->addItem(tr(type->title.data()), name_of(type));
  row->addWidget(type_, 1);
  amount_ = new QDoubleSpinBox(this);
  amount_->setObjectName(QStringLiteral("palpateFilterAmount"));
  amount_->setKeyboardTracking(false);
  row->addWidget(amount_);
  shown_ = new QCheckBox(tr("Show"), this);
  shown_->setObjectName(QStringLiteral("palpateFilterShown"));
  shown_->setToolTip(
      tr("On: the views show the filtered values, as they are felt. Off: the views show the values as scanned."));
  shown_->setChecked(true);
  row->addWidget(shown_);
  column->addLayout(row);
  progress_ = new QProgressBar(this);
  progress_->setObjectName(QStringLiteral("palpateFiltering"));
  progress_->setFormat(tr("Filtering %p%"));
  progress_->hide();
  column->addWidget(progress_);
  message_ = make_message_label(*this, "palpateFilterMessage");
  message_->hide();
  column->addWidget(message_);

  connect(&session_, &SessionController::felt_scan_changed, this, [this] { follow(); });
  connect(type_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    offer_amount();
    ask();
  });
  connect(amount_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this] { ask(); });
  connect(shown_, &QCheckBox::toggled, this, [this] { show_in_views(); });
  connect(&model, &SceneModel::changed, this, [this](Pace pace) {
    if (pace == Pace::stepped) refresh();
  });
  connect(&session, &SessionController::connection_changed, this, [this] { follow_scan(); });
  model.set_make_ready([this](const modes::Scene& scene, const auto& ready) { return make_ready(scene, ready); });
  scans.set_filter([this] { return model_.scene().filter; });
  refresh();
}

void FilterRow::refresh() {
  follow();
  show_in_views();
}

void FilterRow::give_up() {
  if (!brought_back_) cancel();
}

void FilterRow::cancel() {
  loader_.cancel();
  progress_->hide();
  message_->hide();
  follow();
}

/// A choice for another scan or frame does not apply to this one. A filter that undo restores belongs to the scene, on
/// any scan.
void FilterRow::follow_scan() {
  const auto scan = session_.live().scan();
  if (!loader_.is_busy() || !scan || filtered_.lock() == scan) return;
  brought_back_ ? compute(io::Filter(through_), ready_) : cancel();
}

/// The row shows the scene's filter.
void FilterRow::follow() {
  setEnabled(session_.live().scan() && !session_.expects_scan() && !session_.live().scan()->vectors);
  if (!loader_.is_busy()) show(model_.scene().filter);  // else it says what was asked for
}

void FilterRow::show(const io::Filter& filter) {
  const QSignalBlocker quiet(type_), silent(amount_);
  type_->setCurrentIndex(type_->findData(name_of(filter.type)));
  offer_amount();
  if (filter.type == nullptr) return;
  amount_->setValue(filter.type->reads_width         ? filter.width
                    : filter.type->reads_sigma_value ? filter.sigma_value
                                                     : filter.sigma_mm);
}

/// The meaning of the number for the chosen type.
void FilterRow::offer_amount() {
  const QSignalBlocker quiet(amount_);
  const io::FilterType* const type = type_chosen_in(*type_);
  amount_->setVisible(type != nullptr);
  shown_->setVisible(type != nullptr);
  if (type == nullptr) return;
  if (type->reads_width) {
    amount_->setDecimals(0);
    amount_->setSingleStep(2);
    amount_->setRange(3, 5);
    amount_->setSuffix(tr(" pixels"));
    amount_->setToolTip(tr("Width of the square of pixels in a slice"));
    amount_->setValue(3);
  } else if (type->reads_sigma_value) {
    amount_->setDecimals(0);
    amount_->setSingleStep(5);
    amount_->setRange(1, 10000);
    amount_->setSuffix(session_.live().scan() && !session_.live().scan()->unit.empty()
                           ? QStringLiteral(" ") + QString::fromStdString(session_.live().scan()->unit)
                           : QString());
    amount_->setToolTip(tr("Differences smaller than this count as noise"));
    amount_->setValue(usual_noise);
  } else {
    amount_->setDecimals(1);
    amount_->setSingleStep(0.1);
    amount_->setRange(0.3, 5);
    amount_->setSuffix(tr(" mm"));
    amount_->setToolTip(tr("Standard deviation of the Gaussian"));
    amount_->setValue(usual_sigma_mm);
  }
}

io::Filter FilterRow::wanted() const {
  io::Filter filter{.type = type_chosen_in(*type_)};
  const double amount = amount_->value();
  if (filter.type == nullptr) return filter;
  if (filter.type->reads_width) {
    filter.width = amount < 4 ? 3 : 5;
  } else if (filter.type->reads_sigma_value) {
    filter.sigma_value = amount;
  } else {
    filter.sigma_mm = amount;
  }
  return filter;
}

void FilterRow::ask() {
  const io::Filter filter = wanted();
  loader_.cancel();
  progress_->hide();
  if (std::exchange(brought_back_, false)) model_.put_back();
  if (!session_.live().scan() || filter == model_.scene().filter) {
    follow();
    return;
  }
  compute(filter, [this, filter] {
    model_.edit(
        tr("filter"), [filter](modes::Scene& scene) { scene.filter = filter; },
        [alive = QPointer(this)](const QString& why) {
          if (alive) show_message(*alive->message_, why, true);
        });
  });
}

/// Undo, and whatever else changes the scene's text in the pipeline.
bool FilterRow::make_ready(const modes::Scene& scene, const std::function<void()>& ready) {
  loader_.cancel();
  progress_->hide();
  brought_back_ = false;
  const bool is_quick = scene.filter.type == nullptr || scene.filter == model_.scene().filter;
  if (is_quick || !session_.live().scan() || session_.expects_scan()) return false;
  brought_back_ = true;
  compute(scene.filter, ready);
  show(scene.filter);
  return true;
}

void FilterRow::compute(const io::Filter& filter, const std::function<void()>& done) {
  const auto scan = session_.live().scan();
  filtered_ = scan;
  through_ = filter;
  ready_ = done;
  const auto take = [this, done](const std::shared_ptr<const io::Volume>& volume, const std::string& error) {
    progress_->hide();
    if (volume) {
      brought_back_ = false;
      session_.offer(volume);
      done();
    } else if (!error.empty()) {
      if (std::exchange(brought_back_, false)) model_.put_back();
      show_message(*message_, QString::fromStdString(error), true);
    }
    refresh();
  };
  message_->hide();
  progress_->setValue(0);
  progress_->show();
  const auto tell = [this](double part) { progress_->setValue(static_cast<int>(100 * part)); };
  // A series of this machine through the store, where the reader finds the same voxels.
  if (const ScanHandle* const shown = scans_.shown(); shown && shown->of.details()) {
    loader_.load(*shown->of.details(), shown->frame, filter, tell, take);
  } else {
    loader_.filter(scan, filter, tell, take);
  }
}

void FilterRow::show_in_views() {
  pqPipelineSource* const reader = readers_.source();
  if (!reader || !scans_.shown()) return;
  const std::string text = shown_->isChecked() ? modes::to_json(model_.scene().filter) : std::string();
  vtkSMPropertyHelper property(reader->getProxy(), "Filter");
  if (text == property.GetAsString()) return;
  SCOPED_UNDO_EXCLUDE();  // follows from the scene
  {
    SM_SCOPED_TRACE(PropertiesModified).arg("proxy", reader->getProxy());
    property.Set(text.c_str());
    reader->getProxy()->UpdateVTKObjects();
  }
  reader->setModifiedState(pqProxy::UNMODIFIED);
  reader->updatePipeline();
  reader->renderAllViews();
  readers_.views().refresh_values();
}

QString FilterRow::in_words() const {
  const io::Filter& filter = model_.scene().filter;
  if (filter.type == nullptr) return {};
  const QString words = QString::fromStdString(io::in_words(filter));
  return shown_->isChecked() ? words : tr("%1 (the views show unfiltered values)").arg(words);
}

}  // namespace palpate::plugin
