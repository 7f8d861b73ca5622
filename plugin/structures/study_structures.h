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
  std::filesystem::path registration = {};  ///< the file of the one that put it there; empty if none was needed
};
/// Places a structure on a scan, by one of the registrations if the two lie in different frames of reference. Adds what
/// a user should know to the structure's warnings.
Placed place_on(io::Structure& structure, std::span<const io::Registration> registrations, const io::Volume& scan);

/// The same by a motion that was recorded. Returns why it cannot be felt on this scan, or an empty text if it can.
Text place_by(io::Structure& structure, const io::RigidMotion& motion, const io::Volume& scan);

/// Says that a structure, which that box holds, lies wholly outside the scan; empty if some of it may lie inside.
Text off_scan(const io::Structure& structure, const io::StructureBox& box, const io::Geometry& scan);

/// A hash of a patient's id, or of the letters of a name; empty where it is. A scan from a server has them in place of
/// name and id, and they are compared as such.
std::string hashed_id(const std::string& id);
std::string hashed_name(const std::string& name);

/// Whether the scene's structure means this one.
bool is_same(const modes::SceneStructure& named, const io::Structure& structure);

/// Its name in the scene. Adds it to the scene if it is missing, with a number behind the name if the scene has another
/// structure of that name.
std::string name_in_scene(modes::Scene& scene, const io::Structure& structure);

/// Adds a surface at its edge, which resists on the way in.
void add_boundary_of(modes::Scene& scene, const io::Structure& structure);
/// Adds a margin that the stylus is kept out of, and that the panel warns of.
void add_keep_out_of(modes::Scene& scene, const io::Structure& structure, double margin_mm);
/// The widest margin that the scene keeps the stylus out of it with; none: it does not.
std::optional<double> keep_out_of(const modes::Scene& scene, const io::Structure& structure);
/// Lets a mode of the scene act only inside the structure.
void add_gate_of(modes::Scene& scene, std::size_t mode, const io::Structure& structure);

/// What most of the scan's own edges at an outline are like, in the scan's unit.
struct OutlineEdges {
  double per_mm = 0;  ///< how steep; 0: not known, and those of a CT are taken
  double rise = 0;    ///< of the value on the way in, negative where it falls; 0: not known
  double middle = 0;  ///< the value half-way
  bool operator==(const OutlineEdges&) const = default;
};
/// A plane of the patient: that of a slice.
struct HeldPlane {
  io::Vec3 point_mm{0}, normal{0, 0, 1};  ///< unit
  bool operator==(const HeldPlane&) const = default;
};
/// How they hold the stylus.
struct Snap {
  double newtons = 1;
  OutlineEdges edges = {};
  std::optional<HeldPlane> plane = {};  ///< the stylus is held in it, from both sides; none: it is free
};
/// Adds a surface at the scan's edges within 6 mm of the outline, or changes it. It holds on the way in, where the
/// value is half-way; where that is not known, both ways and on the flank of an edge. So near the outline a plane
/// holds, too: more strongly than hand and edge together push.
void snap_to_scan(modes::Scene& scene, const io::Structure& structure, const Snap& snap);
/// The plane that a scene holds the stylus in there; none: it does not.
std::optional<HeldPlane> held_plane(const modes::Scene& scene, const io::Structure& structure);
/// Takes it away again.
void snap_no_more(modes::Scene& scene, const io::Structure& structure);
/// The same of every structure. Whether there was any.
bool snap_no_more(modes::Scene& scene);

}  // namespace palpate::plugin
