#include "plugin/paraview/client/panel/recordings_section.h"

#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QSlider>
#include <QStandardPaths>
#include <QStyle>
#include <QToolButton>
#include <QVBoxLayout>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <glm/geometric.hpp>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/panel/chart_picture.h"
#include "plugin/paraview/client/widgets/message_label.h"
#include "plugin/paraview/client/widgets/tool_button.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

constexpr int force_pixels = 130;
constexpr std::array speeds{0.1, 0.25, 0.5, 1.0, 2.0, 5.0};
constexpr std::size_t most_points_drawn = 2000;

/// One of so many ticks: as many as a line or a chart can show.
std::size_t stride_of(const RecordedSession& session) {
  return std::max<std::size_t>(1, session.size() / most_points_drawn);
}

std::vector<glm::dvec3> path_of(const RecordedSession* session) {
  std::vector<glm::dvec3> path;
  if (!session) return path;
  for (std::size_t n = 0; n < session->size(); n += stride_of(*session)) path.push_back(session->probe_mm(n));
  return path;
}

/// The largest force of each stretch, so that none is missed.
Chart force_of(const RecordedSession& session) {
  Curve force{.label = "", .x = {}, .y = {}};
  const std::size_t stride = stride_of(session);
  for (std::size_t n = 0; n < session.size(); ++n) {
    const double newtons = glm::length(session.sent_n(n));
    if (n % stride == 0) {
      force.x.push_back(session.time_s(n));
      force.y.push_back(newtons);
    } else {
      force.y.back() = std::max(force.y.back(), newtons);
    }
  }
  Chart chart;
  chart.x.label = "time (s)";
  chart.y.label = "force (N)";
  chart.y.minimum = 0;
  chart.curves.push_back(std::move(force));
  return chart;
}

QString ask_for_recording(QWidget* parent) {
  return QFileDialog::getOpenFileName(parent, RecordingsSection::tr("Open recording"),
                                      QStandardPaths::writableLocation(QStandardPaths::DocumentsLocation),
                                      RecordingsSection::tr("Recordings (*.h5)"));
}

}  // namespace

RecordingsSection::RecordingsSection(OpenViews& views, SessionController& session, QWidget* parent)
    : QWidget(parent),
      session_(session),
      first_path_(views, QColor(86, 180, 233)),
      second_path_(views, QColor(230, 159, 0)),
      following_(views.follow(Layer::paths, [this](const auto&) { close_all(); })) {
  setObjectName(QStringLiteral("palpateRecordings"));
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  auto* const row = new QHBoxLayout;
  auto* const open_button = new QPushButton(tr("Open recording…"), this);
  open_button->setObjectName(QStringLiteral("palpateOpenRecording"));
  connect(open_button, &QPushButton::clicked, this, [this] {
    if (const QString file = ask_for_recording(this); !file.isEmpty()) open(file);
  });
  row->addWidget(open_button);
  name_ = new QLabel(this);
  name_->setObjectName(QStringLiteral("palpateRecordingName"));
  name_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  row->addWidget(name_, 1);
  column->addLayout(row);
  column->addWidget(player_ = build_player());
  column->addWidget(comparison_ = new RecordingComparison(this));
  connect(comparison_, &RecordingComparison::told, this, &RecordingsSection::tell);
  message_ = make_message_label(*this, "palpateRecordingMessage");
  column->addWidget(message_);
  session.show_instead([this] {
    const auto& scan = session_.live().scan();
    return playback_.look(scan ? scan->unit : std::string());
  });
  connect(&session, &SessionController::felt_scan_changed, this, [this] { follow_frame(); });
  connect(&session, &SessionController::polled, this, [this] { show_player(); });
  connect(&session, &SessionController::connection_changed, this, [this] {
    if (session_.live().is_connected()) playback_.pause();
    show_player();
  });
  set_first({});
}

RecordingsSection::~RecordingsSection() {
  session_.show_instead({});
}

QWidget* RecordingsSection::build_player() {
  auto* const box = new QWidget(this);
  auto* const column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  force_ = new ChartPicture(force_pixels, box);
  force_->setObjectName(QStringLiteral("palpateRecordedForce"));
  connect(force_, &ChartPicture::picked, this, [this](double seconds) { seek(seconds); });
  column->addWidget(force_);
  auto* const row = new QHBoxLayout;
  // Icons: not every font has a sign for a pause.
  play_ = add_tool_button(*row, *box, "palpatePlay", QString(), tr("Play or pause"), [this] { play_or_pause(); });
  slider_ = new QSlider(Qt::Horizontal, box);
  slider_->setObjectName(QStringLiteral("palpateScrub"));
  connect(slider_, &QSlider::valueChanged, this, [this](int ms) { seek(ms / 1e3); });
  row->addWidget(slider_, 1);
  speed_ = new QComboBox(box);
  speed_->setObjectName(QStringLiteral("palpateReplaySpeed"));
  speed_->setToolTip(tr("Playback speed"));
  for (const double speed : speeds) speed_->addItem(QStringLiteral("%1×").arg(speed), speed);
  speed_->setCurrentIndex(static_cast<int>(std::find(speeds.begin(), speeds.end(), 1.0) - speeds.begin()));
  connect(speed_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int index) { playback_.set_speed(speeds.at(static_cast<std::size_t>(index))); });
  row->addWidget(speed_);
  column->addLayout(row);
  held_ = new QLabel(
      tr("Disconnect the stylus to play a recording. While it is connected, the views show what it feels."), box);
  held_->setObjectName(QStringLiteral("palpatePlayWhyNot"));
  held_->setWordWrap(true);
  held_->hide();
  column->addWidget(held_);
  auto* const last = new QHBoxLayout;
  time_ = new QLabel(box);
  time_->setObjectName(QStringLiteral("palpateReplayTime"));
  last->addWidget(time_, 1);
  auto* const compare = new QPushButton(tr("Compare with…"), box);
  compare->setObjectName(QStringLiteral("palpateCompare"));
  compare->setToolTip(tr("Compares with another recording of the same stroke, place by place. The speeds may differ."));
  connect(compare, &QPushButton::clicked, this, [this] {
    if (const QString file = ask_for_recording(this); !file.isEmpty()) read(file, true);
  });
  last->addWidget(compare);
  auto* const close_button = add_tool_button(*last, *box, "palpateCloseRecording", QStringLiteral("✕"),
                                             tr("Close the recordings"), [this] { close_all(); });
  close_button->setAutoRaise(true);
  column->addLayout(last);
  return box;
}

void RecordingsSection::open(const QString& file) {
  read(file, false);
}

void RecordingsSection::read(const QString& file, bool second) {
  const std::shared_ptr<const io::Volume> volume = session_.live().scan();
  if (!volume) {
    tell(words(say("there-is-no-scan-to-see")), true);
    return;
  }
  const auto read_it = [file, volume] {
    const QString name = QFileInfo(file).fileName();
    try {
      return Opened{{name, std::make_shared<const RecordedSession>(read_recording(file.toStdString()), *volume)},
                    volume};
    } catch (const std::exception& error) {
      // The file's name without its folders, which may hold a patient's.
      std::string what = error.what();
      const std::size_t path = what.find(file.toStdString());
      what = path == std::string::npos ? name.toStdString() + ": " + what
                                       : what.replace(path, file.toStdString().size(), name.toStdString());
      throw std::runtime_error(what);
    }
  };
  (second ? second_job_ : first_job_).ask(read_it, [this, second](const auto& opened, const QString& error) {
    take(opened, error, second);
  });
}

void RecordingsSection::take(const std::shared_ptr<const Opened>& opened, const QString& error, bool second) {
  const auto scan = session_.live().scan();
  if (!opened) {
    tell(error, true);
  } else if (!scan) {
    tell(words(say("there-is-no-scan-to-see")), true);
  } else if (opened->scan.lock() != scan) {
    tell(words(say("recording-was-read-for-another-frame", opened->name.toStdString())), true);
  } else {
    second ? set_second(*opened) : set_first(*opened);
  }
}

/// What was recorded on another frame is not seen over this one.
void RecordingsSection::follow_frame() {
  const auto scan = session_.live().scan();
  if (!first_.session || !scan || first_.scan.lock() == scan) return;
  const QString name = first_.name;
  set_first({});
  tell(words(say("recording-is-of-another-frame", name.toStdString())));
}

void RecordingsSection::set_first(Opened opened) {
  second_job_.cancel();
  first_ = std::move(opened);
  playback_.set_session(first_.session);
  const bool there = first_.session != nullptr;
  name_->setText(first_.name);
  name_->setToolTip(first_.name);
  player_->setVisible(there);
  if (there) {
    const QSignalBlocker quiet(slider_);
    slider_->setRange(0, static_cast<int>(std::lround(1e3 * first_.session->duration_s())));
  }
  tell(there && first_.session->elsewhere() > 0
           ? tr("%1 s are left out: they were recorded on another scan.")
                 .arg(1e-3 * static_cast<double>(first_.session->elsewhere()), 0, 'f', 1)
           : QString());
  show_force();
  set_second({});
  show_player();
}

void RecordingsSection::close_all() {
  first_job_.cancel();
  set_first({});
}

void RecordingsSection::set_second(Opened opened) {
  second_ = std::move(opened);
  comparison_->compare(first_, second_);
  show_paths();
}

void RecordingsSection::play_or_pause() {
  playback_.is_playing() ? playback_.pause() : playback_.play();
  show_player();
}

void RecordingsSection::seek(double seconds) {
  playback_.seek(seconds);
  show_player();
}

void RecordingsSection::show_player() {
  if (!first_.session) return;
  const bool held = session_.live().is_connected();
  play_->setEnabled(!held);
  play_->setIcon(style()->standardIcon(playback_.is_playing() ? QStyle::SP_MediaPause : QStyle::SP_MediaPlay));
  held_->setVisible(held);
  play_->setToolTip(held ? tr("Disconnect the stylus to play. While it is connected, the views show what it feels")
                         : tr("Play or pause"));
  slider_->setEnabled(!held);
  const QSignalBlocker quiet(slider_);
  slider_->setValue(static_cast<int>(std::lround(1e3 * playback_.at_s())));
  time_->setText(tr("%1 of %2 s").arg(playback_.at_s(), 0, 'f', 2).arg(first_.session->duration_s(), 0, 'f', 2));
  force_->set_cursor(playback_.at_s());
}

void RecordingsSection::show_force() {
  if (first_.session) {
    force_->show_charts({force_of(*first_.session)}, first_.session->duration_s());
  } else {
    force_->show_charts({}, 0);
  }
}

void RecordingsSection::show_paths() {
  first_path_.show(path_of(first_.session.get()));
  second_path_.show(path_of(second_.session.get()));
}

void RecordingsSection::tell(const QString& text, bool problem) {
  show_message(*message_, text, problem);
}

}  // namespace palpate::plugin
