#include "plugin/bench/force_errors.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>

#include "io/bounding_box.h"
#include "io/fields/filtered.h"
#include "io/fields/volume_fields.h"
#include "io/quantile.h"
#include "plugin/report/held_boundary.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {
namespace {

constexpr double count_width_n = 0.002;
constexpr std::size_t error_counts = 4000;  // the last holds all that is larger

}  // namespace

FeltScene felt_on_scan(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                       const io::Progress& progress) {
  constexpr std::size_t all_bricks = std::size_t{1} << 30;
  FeltScene felt{.scene = scene, .on = {}, .has_known = true};
  felt.on.plan = plan_for(scene, *volume, glm::dvec3(0.1));
  felt.on.volume = io::filtered(volume, scene.filter, progress);
  io::FieldOptions options = modes::field_options(scene.sampling);
  options.brick_bytes = all_bricks;
  options.background = false;
  const auto fields = std::make_shared<io::VolumeFields>(
      felt.on.volume, scan_fields(*felt.on.plan),
      scene.gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry)), options);
  const io::Box box = io::bounding_box(volume->geometry);
  fields->prepare(0.5 * (box.low + box.high), glm::distance(box.low, box.high));
  felt.on.source = fields;
  return felt;
}

FeltPath feel_path(const FeltScene& felt, const PlannedPath& path, double speed_mm_per_s) {
  const auto begun = std::chrono::steady_clock::now();
  const auto stroke =
      run_stroke(*felt.on.plan, *felt.on.source, path.from_mm, path.to_mm, speed_mm_per_s, StrokeDetail::forces_alone);
  const glm::dvec3 along = glm::normalize(path.to_mm - path.from_mm);
  FeltPath made;
  made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  made.force_n.reserve(stroke.size());
  made.pusher.reserve(stroke.size());
  for (const StrokePoint& point : stroke) {
    made.force_n.emplace_back(point.force_n);
    made.pusher.push_back(point.boundary ? static_cast<std::uint8_t>(*point.boundary) : FeltPath::nothing);
  }
  for (const Contact& contact : contacts_of(stroke, *felt.on.plan, met_n)) {
    const glm::dvec3 place = stroke[contact.first].proxy_mm;
    constexpr double not_said = std::numeric_limits<double>::quiet_NaN();
    made.contacts.push_back(
        {.boundary = contact.boundary,
         .depth_mm = glm::dot(place - path.from_mm, along),
         .place_mm = place,
         .known_mm =
             felt.has_known ? known_to_mm(felt.on, felt.scene, contact.boundary, place).value_or(not_said) : not_said});
  }
  return made;
}

ForceErrors::ForceErrors() : counts_(error_counts), by_pusher_(pushers * pushers) {}

void ForceErrors::add(const FeltPath& truth, const FeltPath& felt,
                      const std::function<double(const glm::dvec3&)>& off_mm) {
  const auto pusher_of = [](const FeltPath& path, std::size_t n) {
    return path.pusher[n] == FeltPath::nothing ? pushers - 1 : std::size_t{path.pusher[n]};
  };
  for (std::size_t n = 0; n < std::min(truth.force_n.size(), felt.force_n.size()); ++n) {
    const double error = glm::distance(glm::dvec3(truth.force_n[n]), glm::dvec3(felt.force_n[n]));
    ++samples_;
    squares_ += error * error;
    by_pusher_[pusher_of(truth, n) * pushers + pusher_of(felt, n)] += error * error;
    affected_ += error > affected_n;
    largest_n_ = std::max(largest_n_, error);
    ++counts_[std::min(static_cast<std::size_t>(error / count_width_n), error_counts - 1)];
  }
  if (truth.contacts.empty() != felt.contacts.empty()) {
    ++missed_;
  } else if (!truth.contacts.empty()) {
    first_contacts_mm_.push_back(std::abs(truth.contacts.front().depth_mm - felt.contacts.front().depth_mm));
  }
  if (!off_mm) return;
  for (const FeltContact& contact : felt.contacts) {
    KnownPlaces& known = known_[contact.boundary];
    if (!std::isfinite(contact.known_mm)) {
      ++known.unstated;
      continue;
    }
    const double off = off_mm(contact.place_mm);
    ++known.contacts;
    known.within += off <= contact.known_mm;
    known.ratios.push_back(static_cast<float>(off / contact.known_mm));
  }
}

void ForceErrors::merge(const ForceErrors& other) {
  samples_ += other.samples_;
  affected_ += other.affected_;
  missed_ += other.missed_;
  refused_ += other.refused_;
  squares_ += other.squares_;
  largest_n_ = std::max(largest_n_, other.largest_n_);
  for (std::size_t n = 0; n < counts_.size(); ++n) counts_[n] += other.counts_[n];
  for (std::size_t n = 0; n < by_pusher_.size(); ++n) by_pusher_[n] += other.by_pusher_[n];
  first_contacts_mm_.insert(first_contacts_mm_.end(), other.first_contacts_mm_.begin(), other.first_contacts_mm_.end());
  for (std::size_t n = 0; n < known_.size(); ++n) {
    known_[n].contacts += other.known_[n].contacts;
    known_[n].within += other.known_[n].within;
    known_[n].unstated += other.known_[n].unstated;
    known_[n].ratios.insert(known_[n].ratios.end(), other.known_[n].ratios.begin(), other.known_[n].ratios.end());
  }
}

double ForceErrors::rms_n() const {
  return samples_ == 0 ? 0 : std::sqrt(squares_ / static_cast<double>(samples_));
}

double ForceErrors::p95_n() const {
  const double wanted = 0.95 * static_cast<double>(samples_);
  double sum = 0;
  for (std::size_t n = 0; n < counts_.size(); ++n) {
    sum += static_cast<double>(counts_[n]);
    if (sum >= wanted && sum > 0) return std::min(count_width_n * static_cast<double>(n + 1), largest_n_);
  }
  return 0;
}

double ForceErrors::affected() const {
  return samples_ == 0 ? 0 : static_cast<double>(affected_) / static_cast<double>(samples_);
}

double ForceErrors::first_contact_mm(double quantile) const {
  return first_contacts_mm_.empty() ? 0 : io::quantile(first_contacts_mm_, quantile);
}

KnownPlaces ForceErrors::known_of_all() const {
  KnownPlaces all;
  for (const KnownPlaces& one : known_) {
    all.contacts += one.contacts;
    all.within += one.within;
    all.unstated += one.unstated;
    all.ratios.insert(all.ratios.end(), one.ratios.begin(), one.ratios.end());
  }
  return all;
}

}  // namespace palpate::plugin
