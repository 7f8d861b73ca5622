#pragma once

/// The box to choose the volume's appearance: as in clinical viewers, or by the felt boundaries.

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

  /// The choices for another scan. `chosen` none: the volume has a different appearance, set elsewhere.
  void set_looks(const std::vector<VolumeLook>& looks, std::optional<std::size_t> chosen);
  /// Whether the volume shows the scene's boundaries, and follows their changes.
  bool is_felt() const;
  /// Selects the felt boundaries for a restored state; emits nothing.
  void choose_felt() { setCurrentIndex(static_cast<int>(looks_.size())); }

 signals:
  void look_chosen(const palpate::plugin::VolumeLook& look);
  void felt_chosen();

 private:
  std::vector<VolumeLook> looks_;
};

}  // namespace palpate::plugin
