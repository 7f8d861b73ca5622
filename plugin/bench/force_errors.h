#pragma once

/// The force along a path, and its error.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "io/progress.h"
#include "modes/scene/scene.h"
#include "plugin/bench/force_paths.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {

/// A scene on its data, and whether it states the uncertainty of its boundaries.
struct FeltScene {
  modes::Scene scene;
  PreparedScene on;
  bool has_known = false;
};

/// The scene on a scan with all gradients computed in advance: no thread works ahead, and each tick takes the same
/// time. Throws io::Cancelled.
FeltScene felt_on_scan(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                       const io::Progress& progress = {});

struct FeltContact {
  std::size_t boundary = 0;  ///< index in the scene's modes
  double depth_mm = 0;       ///< of the proxy along the path, at the first contact
  glm::dvec3 place_mm{0};    ///< of the proxy there
  double known_mm = 0;       ///< known_to_mm() there; NaN if unknown
};

struct FeltPath {
  static constexpr std::uint8_t nothing = 0xff;
  std::vector<glm::vec3> force_n;    ///< of each tick, patient axes
  std::vector<std::uint8_t> pusher;  ///< the scene's mode that pushes most, or nothing
  std::vector<FeltContact> contacts;
  double seconds = 0;  ///< run time
};

/// Moves the probe along the path at a constant speed, one tick a millisecond. Throws Refusal if a balance is not
/// solved.
FeltPath feel_path(const FeltScene& felt, const PlannedPath& path, double speed_mm_per_s);

/// N: larger force errors count as affected.
inline constexpr double affected_n = 0.05;

/// How often the true boundary is within the stated uncertainty.
struct KnownPlaces {
  std::uint64_t contacts = 0, within = 0, unstated = 0;
  std::vector<float> ratios;  ///< of the error to the stated uncertainty, of each contact

  double share() const { return contacts == 0 ? 0 : static_cast<double>(within) / static_cast<double>(contacts); }
};

/// Sums over paths. Adding in the same order gives the same bits.
class ForceErrors {
 public:
  ForceErrors();

  /// `off_mm`: the distance of a place from the nearest true boundary; empty if unknown.
  void add(const FeltPath& truth, const FeltPath& felt, const std::function<double(const glm::dvec3&)>& off_mm);
  void add_refused() { ++refused_; }
  void merge(const ForceErrors& other);

  std::uint64_t samples() const noexcept { return samples_; }
  std::uint64_t refused() const noexcept { return refused_; }
  double rms_n() const;
  double p95_n() const;  ///< 95th percentile of the force errors, to 0.002 N
  double largest_n() const noexcept { return largest_n_; }
  double affected() const;  ///< fraction of the samples with more than affected_n
  /// Distance between the first contacts of both, mm; 0.5 is the median.
  double first_contact_mm(double quantile) const;
  std::uint64_t missed() const noexcept { return missed_; }  ///< paths on which only one meets a boundary first
  const std::array<KnownPlaces, modes::Scene::most_modes>& known() const noexcept { return known_; }
  KnownPlaces known_of_all() const;
  /// Sum of the squares (N^2) of samples in which one mode pushes in the truth and another in the row; the last index
  /// means no mode.
  double squares_of(std::size_t truth, std::size_t felt) const { return by_pusher_[truth * pushers + felt]; }
  double squares() const noexcept { return squares_; }

  static constexpr std::size_t pushers = modes::Scene::most_modes + 1;

 private:
  std::uint64_t samples_ = 0, affected_ = 0, missed_ = 0, refused_ = 0;
  double squares_ = 0, largest_n_ = 0;
  std::vector<std::uint64_t> counts_;  ///< by force error
  std::vector<double> first_contacts_mm_;
  std::vector<double> by_pusher_;
  std::array<KnownPlaces, modes::Scene::most_modes> known_;
};

}  // namespace palpate::plugin
