#include "plugin/paraview/client/panel/sharing_section.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QVBoxLayout>

#include "plugin/paraview/client/widgets/message_label.h"

namespace palpate::plugin {

SharingSection::SharingSection(SharingModel& model, QWidget* parent)
    : QWidget(parent),
      model_(model),
      on_(new QCheckBox(tr("Share with 3D Slicer"), this)),
      port_(new QSpinBox(this)),
      message_(make_message_label(*this, "palpateSharing")) {
  on_->setObjectName(QStringLiteral("palpateShare"));
  on_->setToolTip(
      tr("3D Slicer on this computer sees stylus, force, marks and surfaces, and sends scenes, marks and outlines. "
         "It can neither turn the force on nor raise a limit."));
  port_->setObjectName(QStringLiteral("palpateSharePort"));
  constexpr int first_port = 1024, last_port = 65535;
  port_->setRange(first_port, last_port);
  port_->setValue(igtl::default_port);
  port_->setToolTip(tr("The port that 3D Slicer connects to (OpenIGTLink)"));
  auto* const row = new QHBoxLayout;
  row->addWidget(on_, 1);
  row->addWidget(new QLabel(tr("Port"), this));
  row->addWidget(port_);
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(3);
  column->addLayout(row);
  column->addWidget(message_);
  show_message(*message_, {}, false);
  connect(on_, &QCheckBox::toggled, this, [this](bool on) { turn(on); });
  connect(&model_, &SharingModel::changed, this, [this] { show_state(); });
}

void SharingSection::turn(bool on) {
  if (!on) return model_.turn_off();
  const QString refused = model_.turn_on(port_->value());
  if (refused.isEmpty()) return;
  const QSignalBlocker quiet(*on_);
  on_->setChecked(false);
  show_message(*message_, refused, true);
}

QString SharingSection::in_words() const {
  if (!model_.is_on()) return {};
  const auto clients = static_cast<int>(model_.clients());
  return clients == 0 ? tr("nobody is connected") : clients == 1 ? tr("1 client") : tr("%1 clients").arg(clients);
}

void SharingSection::show_state() {
  const bool on = model_.is_on();
  port_->setEnabled(!on);
  show_message(*message_, on ? tr("Listens on 127.0.0.1, port %1: %2.").arg(model_.port()).arg(in_words()) : QString(),
               false);
}

}  // namespace palpate::plugin
