#pragma once

/// A scene: what a clinician tunes, as plain values. scene_json.h has its text form, plan.h its form for a scan.

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "io/fields/field_options.h"
#include "io/filter.h"
#include "io/structures/edit.h"
#include "modes/scene/defaults.h"
#include "modes/scene/transfer_function.h"
#include "modes/scene/workspace.h"
#include "solver/solver_type.h"

namespace palpate::modes {

/// The datum at the proxy that a transfer function reads.
enum class Datum : std::uint8_t {
  value,               ///< HU for CT, the stored unit for others
  gradient_magnitude,  ///< per mm
  vector_magnitude,    ///< the vector field's unit
  low,                 ///< value on the less dense side of the nearest boundary
  high,                ///< value on the denser side
  distance             ///< from the surface of a structure, mm, positive inside
};

/// Which crossing a surface resists.
enum class Side : std::uint8_t {
  entering,  ///< towards higher values: the skin, pressed from the air
  leaving,   ///< towards lower values, as in equation (10)
  both
};

/// Which directions a force or follow mode reads.
enum class DirectionField : std::uint8_t { vector, gradient };

/// What a landmark is.
enum class Shape : std::uint8_t { point, line, plane };

/// A factor on a strength, normally between 0 and 1. It decides where a mode acts.
struct Gate {
  Datum of = Datum::value;
  TransferFunction factor;
  std::string structure = {};  ///< if `of` is distance: the structure
};

/// One mode of a scene. Every type of mode (mode_type.h) reads some of these and refuses the others.
struct Mode {
  std::string type;  ///< "force", "follow", "surface", "friction", ...
  std::string name;  ///< given by the user; unique in the scene, or empty
  bool enabled = true;
  Datum strength_of = Datum::value;
  std::string strength_structure;  ///< if strength_of is distance: the structure
  TransferFunction strength_n;     ///< N
  std::vector<Gate> gates;         ///< multiplied into the strength
  Side side = Side::entering;
  DirectionField direction_of = DirectionField::vector;
  std::string structure;  ///< the one whose edge a surface follows, or that of keep_out or keep_in; or empty
  double level_mm = 0;    ///< how far inside the structure's edge that surface is
  double margin_mm = 3;   ///< keep_out, keep_in: how far from the edge the force begins, > 0
  std::string from, to;   ///< names of tissues: the boundary that a surface follows, instead of a side; or both empty
  Shape shape = Shape::point;
  Vec3 position_mm{0};      ///< patient space
  Vec3 direction{0, 0, 1};  ///< patient axes, unit: along a line; for a plane, the side that it pushes to
  std::string color;        ///< "#rrggbb", or empty
};

/// A tissue, as a range of values with soft ends.
struct Tissue {
  std::string name;
  double low = 0;       ///< scan's unit
  double high = 0;      ///< > low
  double softness = 0;  ///< width of the soft end at low and high, scan's unit, > 0
  std::string color;    ///< "#rrggbb", or empty
};

/// Something that was outlined on the scan (io/structures). A scene reads the distance from its surface.
struct SceneStructure {
  std::string name;  ///< unique in the scene
  /// The file that holds it; load_scene() makes it absolute, from the scene's own folder. Empty if its edits begin with
  /// contours, which then make it.
  std::string file;
  std::string segment;  ///< its name in the file; or its number; empty without a file
  std::optional<int> segment_number;
  std::string color;                ///< "#rrggbb", or empty
  std::optional<double> margin_mm;  ///< the user is warned when the stylus is nearer than this
  std::vector<io::Edit> edits{};    ///< of its outline, in their order; its file does not change
};

/// Whether a structure has no file, so that the contours at the start of its edits make it.
bool is_drawn(const SceneStructure& structure) noexcept;

struct Limits {
  double force_n = defaults::force_limit_n;
  double slew_n_per_ms = defaults::slew_limit_n_per_ms;
  double ramp_s = defaults::ramp_s;
  double speed_m_per_s = defaults::speed_limit_m_per_s;
};

/// A tick is cut into as many sub-steps as the probe's travel needs (haptic_step.h).
struct Subdivision {
  double step_mm = defaults::sub_step_mm;          ///< probe travel of one sub-step, mm of patient
  int most = defaults::most_sub_steps;             ///< 1: never subdivided
  double proxy_step_mm = defaults::proxy_step_mm;  ///< longer jumps of the proxy are halted on the way, mm of patient
  int most_halts = defaults::most_halts;           ///< 0: never halted
};

/// The placement of the scan in the reach of the hand. place_workspace() makes a Workspace from it for a scan.
struct WorkspaceSettings {
  std::optional<Vec3> center_mm;               ///< patient point at the device's origin; the scan's center by default
  glm::dmat3 rotation = Workspace{}.rotation;  ///< columns: the device's x, y and z axes in patient space
  double scale = defaults::workspace_scale;    ///< mm of patient for one mm of hand
  bool fit = false;                            ///< the scale is chosen so that the whole scan fits the device
};

/// How the scan is read between its voxels (io/fields/field_options.h).
struct Sampling {
  io::ValueMethod value = io::ValueMethod::cubic;
  io::GradientMethod gradient = io::GradientMethod::gaussian;

  bool operator==(const Sampling&) const = default;
};

struct Scene {
  static constexpr int version = 1;  ///< of the text form
  static constexpr std::size_t most_modes = 32;

  std::string name;
  std::string description;
  double stiffness_n_per_m = defaults::stiffness_n_per_m;
  Limits limits;
  WorkspaceSettings workspace;
  solver::SolverSet solvers =
      solver::SolverSet::usual();  ///< allowed solvers; the plan leaves out those that it cannot need
  Subdivision subdivision;
  io::Filter filter;  ///< of the scan's values, applied before they are read
  Sampling sampling;
  std::optional<double> gradient_scale_mm;  ///< by default io::default_gradient_scale_mm() of the scan
  std::vector<Tissue> tissues;
  std::vector<SceneStructure> structures;
  std::vector<Mode> modes;
};

/// Throws std::invalid_argument whose message starts with the path of the bad key: "modes[1].strength_n.nodes[0][1]: -2
/// is negative; a strength is in newtons, 0 or more".
void validate(const Scene& scene);

/// The options for io::VolumeFields.
io::FieldOptions field_options(const Sampling& sampling);

/// The workspace for a scan with this bounding box of its voxels (patient space, mm) and a device that reaches
/// half_extent_m from its origin along each of its own axes.
Workspace place_workspace(const WorkspaceSettings& settings, const Vec3& box_low_mm, const Vec3& box_high_mm,
                          const Vec3& half_extent_m);

}  // namespace palpate::modes
