#pragma once

/// The structures of a study: which of them can be felt on a scan, and how they are added to a scene.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/structures/structure.h"
#include "io/volume.h"
#include "modes/scene/scene.h"

namespace palpate::plugin {

struct Placed {
  Text why_not;                             ///< why it cannot be felt on this scan and what to do; empty if it can
  std::filesystem::path registration = {};  ///< the file of the registration used; empty if none was needed
};
/// Places a structure on a scan, by one of the registrations if their frames of reference differ. Adds warnings to the
/// structure.
Placed place_on(io::Structure& structure, std::span<const io::Registration> registrations, const io::Volume& scan);

/// The same with a recorded motion. Returns why it cannot be felt on this scan, or an empty text if it can.
Text place_by(io::Structure& structure, const io::RigidMotion& motion, const io::Volume& scan);

/// A message if a structure with that box is wholly outside the scan; empty if part of it may be inside.
Text off_scan(const io::Structure& structure, const io::StructureBox& box, const io::Geometry& scan);

/// A hash of a patient's id, or of the letters of a name; empty for an empty text. A server's scan has hashes in place
/// of name and id, and they are compared.
std::string hashed_id(const std::string& id);
std::string hashed_name(const std::string& name);

/// Whether the scene's structure is this one.
bool is_same(const modes::SceneStructure& named, const io::Structure& structure);

/// Its name in the scene. Adds it to the scene if it is missing, with a number after the name if the scene has another
/// structure of that name.
std::string name_in_scene(modes::Scene& scene, const io::Structure& structure);

/// Adds a surface at its edge, which resists on the way in.
void add_boundary_of(modes::Scene& scene, const io::Structure& structure);
/// Adds a margin that the stylus is kept out of, and that the panel warns of.
void add_keep_out_of(modes::Scene& scene, const io::Structure& structure, double margin_mm);
/// The widest margin of the scene's keep-outs of it; none: there is none.
std::optional<double> keep_out_of(const modes::Scene& scene, const io::Structure& structure);
/// Lets a mode of the scene act only inside the structure.
void add_gate_of(modes::Scene& scene, std::size_t mode, const io::Structure& structure);

/// Typical properties of the scan's own edges at an outline, in the scan's unit.
struct OutlineEdges {
  double per_mm = 0;  ///< slope; 0: unknown, and that of a CT is assumed
  double rise = 0;    ///< of the value on the way in, negative if it falls; 0: unknown
  double middle = 0;  ///< the value in the middle of the edge's rise
  bool operator==(const OutlineEdges&) const = default;
};
/// A plane in the patient: that of a slice.
struct HeldPlane {
  io::Vec3 point_mm{0}, normal{0, 0, 1};  ///< unit
  bool operator==(const HeldPlane&) const = default;
};
/// The surface that holds the stylus.
struct Snap {
  double newtons = 1;
  OutlineEdges edges = {};
  std::optional<HeldPlane> plane = {};  ///< holds the stylus in it, from both sides; none: not held
};
/// Adds or changes a surface at the scan's edges within 6 mm of the outline. It holds on the way in, at the value
/// half-way up the edge; if that value is unknown, it holds in both directions, wherever the gradient is steep enough.
/// Within the same 6 mm the plane holds the stylus, too, with more force than hand and edge together push.
void snap_to_scan(modes::Scene& scene, const io::Structure& structure, const Snap& snap);
/// The plane in which a scene holds the stylus at this structure; none: not held.
std::optional<HeldPlane> held_plane(const modes::Scene& scene, const io::Structure& structure);
/// Removes this surface.
void snap_no_more(modes::Scene& scene, const io::Structure& structure);
/// Removes it for every structure. Returns whether there was any.
bool snap_no_more(modes::Scene& scene);

}  // namespace palpate::plugin
