#pragma once

/// A boundary in the list of tissues: switch, color, name, direction and strength.

#include <QCoreApplication>
#include <QObject>
#include <QStringList>

#include <cstddef>
#include <optional>

#include "plugin/paraview/client/model/scene_model.h"
#include "plugin/paraview/client/model/shown_mode.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QGridLayout;
class QLabel;
class QLineEdit;
class QToolButton;

namespace palpate::plugin {

/// The mode for the same surface in the opposite direction, if it follows `mode` in the scene.
std::optional<std::size_t> way_back_of(const modes::Scene& scene, std::size_t mode);

class BoundaryRow : public QObject {
  Q_DECLARE_TR_FUNCTIONS(BoundaryRow)

 public:
  /// In a grid of BoundaryRow::columns. Its widgets belong to `parent`, which must outlive it. A boundary and its
  /// opposite share one row, with a direction.
  BoundaryRow(SceneModel& model, std::size_t mode, int row, QWidget& parent, QGridLayout& grid);

  static constexpr int columns = 6;
  static constexpr int name_column = 2;

  std::size_t mode() const { return mode_; }
  /// Shows the scene's present values.
  void show_values();
  /// Whether it is felt, from either side.
  bool is_felt() const;
  /// The names of boundaries that a hand cannot distinguish from it by strength.
  void set_alike(const QStringList& others);

 private:
  void add_switch(QWidget& parent, QGridLayout& grid, int row);
  void add_name(QWidget& parent, QGridLayout& grid, int row);
  void add_direction(QWidget& parent, QGridLayout& grid, int row);
  void add_strength(QWidget& parent, QGridLayout& grid, int row);
  struct Shown {
    struct Pair {
      modes::Mode* there;
      modes::Mode* back;  ///< null: there is none
    };
    /// Throws as ShownMode does.
    Pair in(modes::Scene& scene) const;

    ShownMode there;
    std::optional<ShownMode> back;
  };
  Shown shown() const;
  void choose_color();
  void edit(const QString& what, const std::function<void(modes::Mode&)>& change);
  void set_felt(const QString& what, bool felt);
  const modes::Mode& of_scene() const { return model_.scene().modes[mode_]; }

  enum Direction { in, out, both };  // in the order of the box

  SceneModel& model_;
  std::size_t mode_;
  std::optional<std::size_t> back_;
  QCheckBox* on_ = nullptr;
  QToolButton* color_ = nullptr;
  QLineEdit* name_ = nullptr;
  QComboBox* direction_ = nullptr;  // null if there is one direction
  QDoubleSpinBox* strength_ = nullptr;
  QLabel* alike_ = nullptr;
};

/// The strength as one number: the curve's maximum, N.
double strength_of(const modes::Mode& mode);
/// Scales the curve to this maximum.
void scale_strength(modes::Mode& mode, double newtons);

}  // namespace palpate::plugin
