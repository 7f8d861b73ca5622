#pragma once

/// One boundary in the list of tissues: whether it is felt, its color, its name, from which side, and how strongly.

#include <QCoreApplication>
#include <QObject>
#include <QStringList>

#include <cstddef>
#include <optional>

#include "plugin/paraview/client/model/scene_model.h"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QGridLayout;
class QLabel;
class QLineEdit;
class QToolButton;

namespace palpate::plugin {

/// The surface between the same two tissues that is felt the other way, if it stands behind that mode in the scene.
std::optional<std::size_t> way_back_of(const modes::Scene& scene, std::size_t mode);

class BoundaryRow : public QObject {
  Q_DECLARE_TR_FUNCTIONS(BoundaryRow)

 public:
  /// In a grid of BoundaryRow::columns. Its widgets belong to `parent`; it goes before them. A boundary and its way
  /// back are one row, with a direction.
  BoundaryRow(SceneModel& model, std::size_t mode, int row, QWidget& parent, QGridLayout& grid);

  static constexpr int columns = 6;
  static constexpr int name_column = 2;

  std::size_t mode() const { return mode_; }
  /// As the scene has it now.
  void show_values();
  /// Whether it is felt, from any side.
  bool is_felt() const;
  /// The names of those that a hand cannot tell from it by their strength.
  void set_alike(const QStringList& others);

 private:
  void add_switch(QWidget& parent, QGridLayout& grid, int row);
  void add_name(QWidget& parent, QGridLayout& grid, int row);
  void add_direction(QWidget& parent, QGridLayout& grid, int row);
  void add_strength(QWidget& parent, QGridLayout& grid, int row);
  void edit(const QString& what, const std::function<void(modes::Mode&)>& change);
  void set_felt(const QString& what, bool felt);
  const modes::Mode& of_scene() const { return model_.scene().modes[mode_]; }

  enum Direction { in, out, both };  // as the box has them

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

/// A strength as one number: the largest, N.
double strength_of(const modes::Mode& mode);
/// The same curve, as strong as that.
void scale_strength(modes::Mode& mode, double newtons);

}  // namespace palpate::plugin
