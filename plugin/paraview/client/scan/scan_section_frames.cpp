#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqRepresentation.h>
#include <pqServer.h>
#include <pqServerManagerModel.h>
#include <pqTimeKeeper.h>
#include <pqView.h>
#include <vtkSMProxy.h>

#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>
#include <QTimer>
#include <QToolButton>

#include <algorithm>
#include <string>
#include <utility>

#include "plugin/app/scan_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/panel/tool_button.h"
#include "plugin/paraview/client/scan/animation_time.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/words.h"

// Which frame of the scan is meant, and whether what is shown is what is felt.

namespace palpate::plugin {
namespace {

bool is_scan(pqPipelineSource& source) {
  return source.getProxy() && source.getProxy()->GetXMLName() == std::string("PalpateDicomReader");
}

bool is_seen(const pqPipelineSource& source) {
  const auto shown = source.getRepresentations(nullptr);
  return std::ranges::any_of(shown, [](const pqDataRepresentation* one) {
    return one->isVisible() && one->getView() && one->getView()->widget()->isVisible();
  });
}

}  // namespace

QWidget* ScanSection::build_frames() {
  auto* const box = new QWidget(this);
  auto* const column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(1);
  frame_text_ = new QLabel(box);
  frame_text_->setObjectName(QStringLiteral("palpateFrameText"));
  column->addWidget(frame_text_);
  auto* const row = new QHBoxLayout;
  const auto add = [&](const char* name, const char* sign, const QString& tip, auto frame) {
    add_tool_button(*row, *box, name, QString::fromUtf8(sign), tip, [this, frame] { go_to_frame(frame()); });
  };
  add("palpateFrameFirst", "|◀", tr("First frame"), [] { return 0; });
  add("palpateFrameBack", "◀", tr("One frame back"), [this] { return handle_.frame - 1; });
  frame_ = new QSlider(Qt::Horizontal, box);
  frame_->setObjectName(QStringLiteral("palpateFrame"));
  frame_->setToolTip(tr("The frame that is shown and felt: the same as ParaView's time"));
  connect(frame_, &QSlider::valueChanged, this, [this](int frame) { go_to_frame(frame); });
  row->addWidget(frame_, 1);
  add("palpateFrameNext", "▶", tr("One frame on"), [this] { return handle_.frame + 1; });
  add("palpateFrameLast", "▶|", tr("Last frame"), [this] { return handle_.frames - 1; });
  column->addLayout(row);
  box->hide();
  return box;
}

void ScanSection::show_frame() {
  frames_->setVisible(handle_.frames > 1);
  const QSignalBlocker quiet(frame_);
  frame_->setRange(0, handle_.frames - 1);
  frame_->setValue(frame_of_time());
  frame_text_->setText(handle_.frame_in_words());
  views_.set_frame_text(handle_.frame_in_words());
}

int ScanSection::frame_of_time() const {
  if (!source_) return handle_.frame;
  return frame_at(handle_.frames, source_->getServer()->getTimeKeeper()->getTime());
}

/// The voxels first, in the background; then ParaView's time, which all views follow.
void ScanSection::go_to_frame(int frame) {
  if (handle_.frames <= 1 || !source_) return;
  const int wanted = std::clamp(frame, 0, handle_.frames - 1);
  if (!catalogue_shown_) {
    set_animation_time(wanted);
    return;
  }
  frame_loader_.load(
      scan_at(*catalogue_shown_, series_shown_), wanted, felt_filter(), [](double) {},
      [this, wanted](const auto& volume, const std::string& error) {
        if (!error.empty()) tell(QString::fromStdString(error), true);
        coming_ = volume;
        if (volume) set_animation_time(wanted);
        if (wanted == handle_.frame) show_frame();
      });
}

const io::Series* ScanSection::series_shown() const {
  return catalogue_shown_ ? &scan_at(*catalogue_shown_, series_shown_) : nullptr;
}

io::Filter ScanSection::felt_filter() const {
  return filter_ ? filter_() : io::Filter{};
}

void ScanSection::watch_time() {
  disconnect(time_);
  // Once ParaView is done with it.
  time_ = connect(source_->getServer()->getTimeKeeper(), &pqTimeKeeper::timeChanged, this,
                  [this] { QTimer::singleShot(0, this, [this] { follow_time(); }); });
}

void ScanSection::follow_time() {
  if (!source_ || source_ != felt_source_ || handle_.frames <= 1) return;
  const int frame = frame_of_time();
  show_frame();
  if (!catalogue_shown_ && frame != handle_.frame) fetch_frame(frame);
  if (frame == handle_.frame || !catalogue_shown_) return;
  frame_loader_.load(
      scan_at(*catalogue_shown_, series_shown_), frame, felt_filter(), [](double) {},
      [this, frame](const auto& volume, const std::string& error) {
        coming_.reset();
        if (!volume) {
          if (!error.empty()) tell(QString::fromStdString(error), true);
          return;
        }
        show_frame_of(volume, frame);
      });
}

void ScanSection::show_frame_of(const std::shared_ptr<const io::Volume>& volume, int frame) {
  handle_.frame = frame;
  handle_.volume = volume;
  show_frame();
  views_.refresh_values();
  emit frame_shown(handle_);
}

QString ScanSection::why_not_felt() const {
  if (!source_) return words(say("scan-left-the-pipeline"));
  if (source_ != felt_source_ || server_scan_.is_busy()) return words(say("scan-is-still-being-read"));
  if (!is_seen(*source_)) {
    return words(say("no-view-shows-the-scan"));
  }
  pqPipelineSource* const active = pqActiveObjects::instance().activeSource();
  if (active && active != source_ && is_scan(*active)) {
    return words(say("another-scan-is-active-in-the-pipeline", active->getSMName().toStdString(),
                     source_->getSMName().toStdString()));
  }
  if (const int frame = frame_of_time(); frame != handle_.frame && !frame_loader_.is_busy()) {
    return words(say("views-show-another-scan", handle_.frame_in_words(frame).toStdString(),
                     handle_.frame_in_words().toStdString()));
  }
  return {};
}

QStringList ScanSection::others_shown() const {
  QStringList names;
  for (auto* const source : pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>()) {
    if (source != source_ && is_scan(*source) && is_seen(*source)) names << source->getSMName();
  }
  return names;
}

}  // namespace palpate::plugin
