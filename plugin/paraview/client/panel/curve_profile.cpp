#include "plugin/paraview/client/panel/curve_profile.h"

#include <QLabel>
#include <QStringList>
#include <QVBoxLayout>

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/paraview/client/panel/chart_picture.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

constexpr int small_chart_pixels = 110;
constexpr int rested_ms = 250;
constexpr double half_length_mm = 15;
constexpr double same_mm = 1;

/// The curves of the force as it was, in one gray.
std::vector<Curve> faded(std::vector<Curve> curves) {
  for (Curve& curve : curves) {
    curve.color = colors::gray;
    curve.dashed = true;
    curve.label.clear();
  }
  return curves;
}

}  // namespace

CurveProfile::CurveProfile(SessionController& session, SceneModel& model, StrokeRunner& strokes, QWidget* parent)
    : QWidget(parent), strokes_(strokes) {
  setObjectName(QStringLiteral("palpateCurveProfile"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  chart_ = new ChartPicture(small_chart_pixels, this);
  chart_->setObjectName(QStringLiteral("palpateCurveProfileChart"));
  chart_->setToolTip(
      tr("The force along a line in the present scene. The dashed line shows it before the last drag. Hold "
         "the pointer still over a boundary in a slice, touch a boundary, or pick two points in Force profile."));
  column->addWidget(chart_);
  words_ = new QLabel(this);
  words_->setObjectName(QStringLiteral("palpateCurveProfileWords"));
  words_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  words_->setTextFormat(Qt::PlainText);
  words_->setWordWrap(true);
  column->addWidget(words_);
  rest_.setSingleShot(true);
  rest_.setInterval(rested_ms);
  connect(&rest_, &QTimer::timeout, this, [this] {
    across_ = std::exchange(proposed_, std::nullopt);
    before_.reset();
    run();
  });
  connect(&model, &SceneModel::changed, this, [this](Pace pace) {
    const bool began = pace == Pace::dragged && !dragging_;
    dragging_ = pace == Pace::dragged;
    if (began) before_ = made_;
    if (!dragging_) before_.reset();
    run();
  });
  connect(&session, &SessionController::connection_changed, this, [this] { run(); });
  run();
}

CurveProfile::~CurveProfile() = default;

void CurveProfile::choose(const WantedStroke& stroke) {
  chosen_ = stroke;
  before_.reset();
  run();
}

void CurveProfile::point_at(const glm::dvec3& place, const glm::dvec3& gradient) {
  if (glm::length(gradient) > 0) propose({.place = place, .inward = gradient});
}

void CurveProfile::touch_at(const glm::dvec3& place, const glm::dvec3& inward) {
  if (glm::length(inward) > 0) propose({.place = place, .inward = inward, .touched = true});
}

void CurveProfile::propose(const Across& across) {
  const std::optional<Across>& last = proposed_ ? proposed_ : across_;
  if (last && glm::distance(last->place, across.place) < same_mm) return;
  proposed_ = across;
  rest_.start();
}

void CurveProfile::forget() {
  rest_.stop();
  proposed_.reset();
  across_.reset();
  before_.reset();
  run();
}

void CurveProfile::rest() {
  dragging_ = false;
}

void CurveProfile::showEvent(QShowEvent*) {
  run();
}

WantedStroke CurveProfile::stroke() const {
  if (chosen_.is_whole() || !across_) return chosen_;
  const glm::dvec3 half = half_length_mm * glm::normalize(across_->inward);
  return {.from = across_->place - half, .to = across_->place + half};
}

void CurveProfile::run() {
  if (!isVisible()) {  // run again when it is seen
    job_.cancel();
    return;
  }
  QString why = tr("Hold the pointer still over a boundary in a slice: the force across it is drawn here.");
  try {
    if (const auto profile = strokes_.run(stroke())) {
      job_.ask([profile] { return make(profile()); },
               [this](const auto& made, const QString& error) {
                 made_ = made;
                 made_ ? show_made() : words_->setText(error);
               });
      return;
    }
  } catch (const std::exception& error) {
    why = QString::fromUtf8(error.what());
  }
  job_.cancel();
  made_.reset();
  before_.reset();
  chart_->show_charts({}, 0);
  words_->setText(why);
}

CurveProfile::Made CurveProfile::make(const Profile& profile) {
  constexpr std::size_t most_points = 500;
  Made made;
  made.chart = charts_of(thinned(profile, most_points)).front();
  made.length_mm = depth_of(profile, profile.stroke.size() - 1);
  QStringList met;
  for (const MetBoundary& boundary : profile.met) {
    met << tr("%1 up to %2 N")
               .arg(QString::fromStdString(display_name(profile.scene, boundary.contact.boundary)))
               .arg(boundary.contact.peak_n, 0, 'f', 2);
  }
  made.met = met.isEmpty() ? tr("no boundary is met") : met.join(QStringLiteral(", "));
  return made;
}

void CurveProfile::show_made() {
  Chart chart = made_->chart;
  if (before_) {
    std::vector<Curve> curves = faded(before_->chart.curves);
    curves.insert(curves.end(), chart.curves.begin(), chart.curves.end());
    chart.curves = std::move(curves);
    chart.y.maximum = std::max(*chart.y.maximum, *before_->chart.y.maximum);
  }
  chart_->show_charts({std::move(chart)}, made_->length_mm);
  const QString where = chosen_.is_whole() ? tr("Along the chosen stroke")
                        : across_->touched ? tr("Across the place last touched")
                                           : tr("Across the place pointed at");
  const QString now = tr("%1: %2.").arg(where, made_->met);
  words_->setText(before_ ? tr("%1 Before: %2.").arg(now, before_->met) : now);
}

}  // namespace palpate::plugin
