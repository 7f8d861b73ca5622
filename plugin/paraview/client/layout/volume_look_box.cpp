#include "plugin/paraview/client/layout/volume_look_box.h"

namespace palpate::plugin {

VolumeLookBox::VolumeLookBox(QWidget* parent) : QComboBox(parent) {
  setObjectName(QStringLiteral("palpateVolumeLook"));
  setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  constexpr int characters = 9;
  setMinimumContentsLength(characters);
  setToolTip(tr("How the volume is drawn. 'Felt boundaries' shows each boundary that is switched on, in its color."));
  setPlaceholderText(tr("From the state file"));
  setEnabled(false);
  connect(this, QOverload<int>::of(&QComboBox::activated), this, [this] {
    const auto chosen = static_cast<std::size_t>(currentIndex());
    is_felt() ? emit felt_chosen() : emit look_chosen(looks_.at(chosen));
  });
}

void VolumeLookBox::set_looks(const std::vector<VolumeLook>& looks, std::optional<std::size_t> chosen) {
  looks_ = looks;
  clear();
  for (const VolumeLook& look : looks_) addItem(tr(look.name));
  addItem(tr("Felt boundaries"));
  setCurrentIndex(chosen ? static_cast<int>(*chosen) : -1);
  setEnabled(true);
}

bool VolumeLookBox::is_felt() const {
  return !looks_.empty() && currentIndex() == static_cast<int>(looks_.size());
}

}  // namespace palpate::plugin
