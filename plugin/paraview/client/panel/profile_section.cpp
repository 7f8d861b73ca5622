#include "plugin/paraview/client/panel/profile_section.h"

#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QVBoxLayout>

#include <algorithm>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/app/vector_text.h"
#include "plugin/paraview/client/panel/chart_picture.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/tool_button.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

constexpr int chart_pixels = 150;

QString text_of(const glm::dvec3& place) {
  return QStringLiteral("%1, %2, %3").arg(place.x, 0, 'f', 1).arg(place.y, 0, 'f', 1).arg(place.z, 0, 'f', 1);
}

}  // namespace

ProfileSection::ProfileSection(OpenViews& views, SessionController& session, SceneModel& model, StrokeRunner& strokes,
                               QWidget* parent)
    : QWidget(parent),
      session_(session),
      strokes_(strokes),
      path_(views, QColor(230, 80, 210)),
      following_(views.follow(Layer::paths, [this](const auto&) { forget(); })) {
  setObjectName(QStringLiteral("palpateProfile"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  column->addWidget(build_points());
  chart_ = new ChartPicture(chart_pixels, this);
  chart_->setObjectName(QStringLiteral("palpateProfileChart"));
  connect(chart_, &ChartPicture::pointed, this, [this](double depth_mm) { point_at(depth_mm); });
  column->addWidget(chart_);
  readout_ = new QLabel(this);
  readout_->setObjectName(QStringLiteral("palpateProfileReadout"));
  readout_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  readout_->setTextFormat(Qt::PlainText);
  readout_->setWordWrap(true);
  column->addWidget(readout_);
  save_ = add_save_buttons(
      *column, *this, QStringLiteral("Profile"),
      [this](bool table) -> std::function<void(const std::string&)> {
        return [made = made_, table](const std::string& file) {
          table ? write_csv(made->profile, file) : write_png(charts_of(made->profile), file);
        };
      },
      [this](const QString& problem) { tell(problem, true); });
  connect(&model, &SceneModel::changed, this, [this](Pace) { run(); });
  connect(&session, &SessionController::connection_changed, this, [this] { run(); });
  show_nothing({});
}

ProfileSection::~ProfileSection() = default;

QWidget* ProfileSection::build_points() {
  auto* const box = new QWidget(this);
  auto* const grid = new QGridLayout(box);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->setVerticalSpacing(2);
  pick_ = new QPushButton(tr("Pick two points"), box);
  pick_->setObjectName(QStringLiteral("palpateProfilePick"));
  pick_->setCheckable(true);
  pick_->setToolTip(tr("In a slice or in the 3D view: drag from the start point to the end point, or click on both."));
  connect(pick_, &QPushButton::toggled, this, [this](bool on) { emit picking(on); });
  grid->addWidget(pick_, 0, 0, 1, 2);
  speed_ = new QDoubleSpinBox(box);
  speed_->setObjectName(QStringLiteral("palpateProfileSpeed"));
  speed_->setRange(5, 500);
  speed_->setValue(stroke_.speed_mm_per_s);
  speed_->setDecimals(0);
  speed_->setSuffix(tr(" mm/s"));
  speed_->setKeyboardTracking(false);
  speed_->setToolTip(tr("How fast the stylus goes along the stroke"));
  connect(speed_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this](double speed) {
    stroke_.speed_mm_per_s = speed;
    change();
  });
  grid->addWidget(speed_, 0, 2, 1, 2);
  const auto add = [&](int row, const char* name, const QString& label,
                       std::optional<glm::dvec3> WantedStroke::*point) {
    auto* const field = new QLineEdit(box);
    field->setObjectName(QString::fromLatin1(name));
    field->setPlaceholderText(tr("x, y, z"));
    field->setToolTip(tr("DICOM patient coordinates (LPS) in mm: + to the left, to the back, to the head"));
    connect(field, &QLineEdit::editingFinished, this, [this, point, field] { read_point(point, *field); });
    grid->addWidget(new QLabel(label, box), row, 0);
    grid->addWidget(field, row, 1, 1, 2);
    auto* const cell = new QHBoxLayout;
    const std::string button = std::string(name) + "Stylus";
    add_tool_button(*cell, *this, button.c_str(), tr("Stylus"), tr("Uses the place where the stylus is now"),
                    [this, point] {
                      if (session_.last().connected) set_point(point, session_.last().probe_mm);
                    });
    grid->addLayout(cell, row, 3);
    return field;
  };
  from_ = add(1, "palpateProfileFrom", tr("From"), &WantedStroke::from);
  to_ = add(2, "palpateProfileTo", tr("To"), &WantedStroke::to);
  grid->setColumnStretch(1, 1);
  return box;
}

void ProfileSection::forget() {
  pick_->setChecked(false);
  stroke_ = {.from = {}, .to = {}, .speed_mm_per_s = stroke_.speed_mm_per_s};
  strokes_.forget();
  show_points();
}

void ProfileSection::pick(Pick what, const glm::dvec3& place) {
  constexpr double same_mm = 1;  // a click, not a drag
  switch (what) {
    case Pick::pressed:
      if (!stroke_.from || stroke_.to) stroke_ = {.from = place, .to = {}, .speed_mm_per_s = stroke_.speed_mm_per_s};
      break;
    case Pick::moved:
      if (glm::distance(*stroke_.from, place) > same_mm) stroke_.to = place;
      break;
    case Pick::let_go:
      stroke_.to.reset();
      if (glm::distance(*stroke_.from, place) > same_mm) {
        stroke_.to = place;
        pick_->setChecked(false);
      }
      break;
  }
  show_points(what != Pick::let_go);
}

void ProfileSection::set_point(std::optional<glm::dvec3> WantedStroke::*point, const glm::dvec3& place) {
  stroke_.*point = place;
  show_points();
}

void ProfileSection::read_point(std::optional<glm::dvec3> WantedStroke::*point, const QLineEdit& field) {
  try {
    if (const glm::dvec3 place = parse_vector(field.text().remove(' ').toStdString(), "the point");
        !(stroke_.*point) || text_of(*(stroke_.*point)) != text_of(place)) {
      set_point(point, place);
    }
  } catch (const std::exception& error) {
    if (!field.text().isEmpty()) tell(QString::fromUtf8(error.what()), true);
  }
}

void ProfileSection::show_points(bool passing) {
  from_->setText(stroke_.from ? text_of(*stroke_.from) : QString());
  to_->setText(stroke_.to ? text_of(*stroke_.to) : QString());
  path_.show(stroke_.is_whole() ? std::vector{*stroke_.from, *stroke_.to} : std::vector<glm::dvec3>{}, passing);
  change();
}

void ProfileSection::change() {
  emit stroke_changed(stroke_);
  run();
}

void ProfileSection::showEvent(QShowEvent*) {
  run();
}

void ProfileSection::run() {
  if (!stroke_.is_whole()) {
    show_nothing({});
    return;
  }
  if (!isVisible()) return;  // folded away: nobody sees it
  const double ticks = 1e3 * glm::distance(*stroke_.from, *stroke_.to) / stroke_.speed_mm_per_s;
  constexpr double most_ticks = 200000;
  if (ticks > most_ticks) {
    show_nothing(
        tr("The stroke would take %1 s: choose nearer points or a higher speed, so that it takes at most %2 s.")
            .arg(ticks / 1e3, 0, 'f', 0)
            .arg(most_ticks / 1e3, 0, 'f', 0));
    return;
  }
  try {
    if (const auto profile = strokes_.run(stroke_)) {
      job_.ask([profile] { return make(profile()); },
               [this](const auto& made, const QString& error) { show_profile(made, error); });
    } else {
      show_nothing({});
    }
  } catch (const std::exception& error) {
    show_nothing(QString::fromUtf8(error.what()));
  }
}

ProfileSection::Made ProfileSection::make(Profile profile) {
  constexpr std::size_t most_points = 2000;
  Made made;
  made.charts = charts_of(thinned(profile, most_points));
  made.charts.pop_back();  // how far the probe is ahead of the proxy follows from the force
  QStringList met;
  for (const MetBoundary& boundary : profile.met) {
    const QString words = tr("%1 at %2 mm, up to %3 N")
                              .arg(QString::fromStdString(display_name(profile.scene, boundary.contact.boundary)))
                              .arg(boundary.depth_mm, 0, 'f', 1)
                              .arg(boundary.contact.peak_n, 0, 'f', 2);
    met << (boundary.known_to_mm ? tr("%1, known to ±%2 mm").arg(words).arg(*boundary.known_to_mm, 0, 'g', 2) : words);
  }
  made.met = met.isEmpty() ? tr("No boundary is met.") : met.join(QStringLiteral("\n"));
  made.profile = std::move(profile);
  return made;
}

void ProfileSection::show_profile(std::shared_ptr<const Made> made, const QString& error) {
  if (!made || !stroke_.is_whole()) {
    show_nothing(error);
    return;
  }
  made_ = std::move(made);
  for (QPushButton* const button : save_.both) button->setEnabled(true);
  chart_->show_charts(made_->charts, depth_of(made_->profile, made_->profile.stroke.size() - 1));
  tell(made_->met, false);
}

void ProfileSection::show_nothing(const QString& why) {
  job_.cancel();
  made_.reset();
  for (QPushButton* const button : save_.both) button->setEnabled(false);
  chart_->show_charts({}, 0, tr("Force against depth along a stroke through the scan, as it would be felt now"));
  tell(why, !why.isEmpty());
}

void ProfileSection::point_at(double depth_mm) {
  if (!made_) return;
  if (std::isnan(depth_mm)) {
    chart_->set_cursor({});
    tell(made_->met, false);
    return;
  }
  const Profile& profile = made_->profile;
  const std::size_t last = profile.stroke.size() - 1;
  const auto point = static_cast<std::size_t>(
      std::lround(std::clamp(depth_mm / depth_of(profile, last), 0.0, 1.0) * static_cast<double>(last)));
  chart_->set_cursor(depth_of(profile, point));
  tell(QString::fromStdString(point_in_words(profile, point)), false);
}

void ProfileSection::tell(const QString& text, bool problem) {
  set_message(*readout_, text, problem);
}

}  // namespace palpate::plugin
