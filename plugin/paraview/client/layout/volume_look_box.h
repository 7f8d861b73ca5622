#pragma once

/// The box that says how the volume is shown: as clinical viewers do, or by the boundaries that are felt.

#include <QComboBox>

#include <cstddef>
#include <optional>
#include <vector>

#include "plugin/paraview/common/scan_look.h"

namespace palpate::plugin {

class VolumeLookBox : public QComboBox {
  Q_OBJECT

 public:
  explicit VolumeLookBox(QWidget* parent = nullptr);

  /// Of another scan; `chosen` none: it is shown as somebody else has set it.
  void set_looks(const std::vector<VolumeLook>& looks, std::optional<std::size_t> chosen);
  /// The scene's boundaries are shown, whichever they become.
  bool is_felt() const;
  /// Says so of what was restored; emits nothing.
  void choose_felt() { setCurrentIndex(static_cast<int>(looks_.size())); }

 signals:
  void look_chosen(const palpate::plugin::VolumeLook& look);
  void felt_chosen();

 private:
  std::vector<VolumeLook> looks_;
};

}  // namespace palpate::plugin
