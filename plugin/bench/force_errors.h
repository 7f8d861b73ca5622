#pragma once

/// What is felt along a path, and how far it is from what should be felt.

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

/// A scene on its data, and whether it says how well its boundaries are known.
struct FeltScene {
  modes::Scene scene;
  PreparedScene on;
  bool has_known = false;
};

/// The scene on a scan with all of its gradients computed: no thread works ahead, and each tick costs the same. Throws
/// io::Cancelled.
FeltScene felt_on_scan(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                       const io::Progress& progress = {});

struct FeltContact {
  std::size_t boundary = 0;  ///< index in the scene's modes
  double depth_mm = 0;       ///< of the proxy along the path, where the boundary is first met
  glm::dvec3 place_mm{0};    ///< of the proxy there
  double known_mm = 0;       ///< known_to_mm() there; NaN where it says nothing
};

struct FeltPath {
  static constexpr std::uint8_t nothing = 0xff;
  std::vector<glm::vec3> force_n;    ///< of each tick, patient axes
  std::vector<std::uint8_t> pusher;  ///< the scene's mode that pushes most, or nothing
  std::vector<FeltContact> contacts;
  double seconds = 0;  ///< to feel it
};

/// The probe moves along the path at a constant speed, one tick a millisecond. Throws Refusal if a balance is not
/// solved.
FeltPath feel_path(const FeltScene& felt, const PlannedPath& path, double speed_mm_per_s);

/// N: force errors that are larger count as affected.
inline constexpr double affected_n = 0.05;

/// How often the truth lies within what is stated.
struct KnownPlaces {
  std::uint64_t contacts = 0, within = 0, unstated = 0;
  std::vector<float> ratios;  ///< of the error to what is stated, of each contact

  double share() const { return contacts == 0 ? 0 : static_cast<double>(within) / static_cast<double>(contacts); }
};

/// Sums over paths. Added in the same order they have the same bits.
class ForceErrors {
 public:
  ForceErrors();

  /// `off_mm`: how far a place is from the nearest true boundary; empty if nobody knows.
  void add(const FeltPath& truth, const FeltPath& felt, const std::function<double(const glm::dvec3&)>& off_mm);
  void add_refused() { ++refused_; }
  void merge(const ForceErrors& other);

  std::uint64_t samples() const noexcept { return samples_; }
  std::uint64_t refused() const noexcept { return refused_; }
  double rms_n() const;
  double p95_n() const;  ///< 95 % of the force errors are at most this, to 0.002 N
  double largest_n() const noexcept { return largest_n_; }
  double affected() const;  ///< part of the samples with more than affected_n
  /// mm, of first contacts that both have: 0.5 is the median.
  double first_contact_mm(double quantile) const;
  std::uint64_t missed() const noexcept { return missed_; }  ///< paths on which one alone meets a boundary first
  const std::array<KnownPlaces, modes::Scene::most_modes>& known() const noexcept { return known_; }
  KnownPlaces known_of_all() const;
  /// Sum of the squares (N^2) of samples at which the truth is pushed by one mode and the other by another; the last is
  /// nothing.
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
