#include "plugin/paraview/client/scan/frame_row.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>

#include "plugin/paraview/client/widgets/tool_button.h"

namespace palpate::plugin {

FrameRow::FrameRow(ScanModel& model, QWidget* parent) : QWidget(parent), model_(model) {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(1);
  text_ = new QLabel(this);
  text_->setObjectName(QStringLiteral("palpateFrameText"));
  column->addWidget(text_);
  auto* const row = new QHBoxLayout;
  const auto add = [&](const char* name, const char* sign, const QString& tip, auto frame) {
    add_tool_button(*row, *this, name, QString::fromUtf8(sign), tip, [this, frame] {
      if (const ScanHandle* const scan = model_.shown()) model_.go_to_frame(frame(*scan));
    });
  };
  add("palpateFrameFirst", "|◀", tr("First frame"), [](const ScanHandle&) { return 0; });
  add("palpateFrameBack", "◀", tr("One frame back"), [](const ScanHandle& scan) { return scan.frame - 1; });
  frame_ = new QSlider(Qt::Horizontal, this);
  frame_->setObjectName(QStringLiteral("palpateFrame"));
  frame_->setToolTip(tr("The frame that is shown and felt. ParaView's time follows it."));
  connect(frame_, &QSlider::valueChanged, this, [this](int frame) { model_.go_to_frame(frame); });
  row->addWidget(frame_, 1);
  add("palpateFrameNext", "▶", tr("Next frame"), [](const ScanHandle& scan) { return scan.frame + 1; });
  add("palpateFrameLast", "▶|", tr("Last frame"), [](const ScanHandle& scan) { return scan.frames - 1; });
  column->addLayout(row);
  connect(&model, &ScanModel::changed, this, [this] { refresh(); });
  hide();
}

void FrameRow::refresh() {
  const ScanHandle* const scan = model_.shown();
  setVisible(scan && scan->frames > 1);
  if (!scan) return;
  const QSignalBlocker quiet(frame_);
  frame_->setRange(0, scan->frames - 1);
  frame_->setValue(model_.wanted_frame());
  text_->setText(scan->frame_in_words());
}

}  // namespace palpate::plugin
