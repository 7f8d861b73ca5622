#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "io/messages.h"
#include "io/structures/edit_changes.h"
#include "io/structures/field_patch.h"

namespace palpate::io::internal {
namespace {

constexpr std::size_t most_of_a_piece = 400;
constexpr double usual_move_mm = 2;   // standard deviation of what a trace moves: how much an uncertain point weighs
constexpr double carried = 0.45;      // of the reach: the bump of one point is connected up to 0.47 of the reach
constexpr double well_met_mm = 0.03;  // points nearer than this need no further change
constexpr double worst_sigma = 1e6;   // of `usual_move_mm`: such a point weighs nothing; its square is still a number
constexpr double settled_mm = 0.2;    // farther than this the distance has to be measured once more
constexpr int most_traced_rounds = 3;

struct TracePoint {
  Vec3 place{0};
  double known_to_mm = 0;
};

/// In order; a point within a quarter of the reach of a kept one is left out.
std::vector<TracePoint> thinned(const TraceEdit& edit) {
  std::vector<TracePoint> kept;
  const double apart = edit.reach_mm / 4;
  for (std::size_t n = 0; n < edit.points_mm.size(); ++n) {
    const Vec3& place = edit.points_mm[n];
    const bool is_new = std::none_of(kept.rbegin(), kept.rend(),
                                     [&](const TracePoint& one) { return glm::distance(one.place, place) < apart; });
    if (is_new) kept.push_back({place, edit.known_to_mm.empty() ? 0 : edit.known_to_mm[n]});
  }
  return kept;
}

/// c of (W + diag(mu s^2)) c = -mm; s = 0 if the fit is to be exact.
class Fit {
 public:
  Fit(const std::vector<TracePoint>& points, double reach_mm, bool exact) : reach_mm_(reach_mm) {
    const auto count = static_cast<Eigen::Index>(points.size());
    Eigen::MatrixXd w(count, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const TracePoint& point = points[static_cast<std::size_t>(i)];
      at_.push_back(point.place);
      for (Eigen::Index j = 0; j <= i; ++j) {
        w(i, j) = w(j, i) = wendland(glm::distance(point.place, at_[static_cast<std::size_t>(j)]) / reach_mm);
      }
      const double sigma = exact ? 0 : std::min(0.5 * point.known_to_mm / usual_move_mm, worst_sigma);
      w(i, i) += sigma * sigma;
    }
    solved_.compute(w);
  }

  std::shared_ptr<const RadialBumps> against(const Eigen::VectorXd& mm) const {
    const Eigen::VectorXd weights = solved_.solve(-mm);
    return std::make_shared<const RadialBumps>(
        RadialBumps{.at = at_, .weight = {weights.begin(), weights.end()}, .reach_mm = reach_mm_});
  }

 private:
  double reach_mm_;
  std::vector<Vec3> at_;
  Eigen::LDLT<Eigen::MatrixXd> solved_;
};

FieldChange change_by(const std::shared_ptr<const RadialBumps>& bumps) {
  FieldChange change;
  for (const Vec3& at : bumps->at) change.where.push_back({at, at});
  change.touched_mm = change.within_mm = bumps->reach_mm;
  change.after = [bumps](const Vec3& at, double before, std::span<const std::uint32_t> near) {
    return before + sum_of(*bumps, near, at);
  };
  change.bumps = bumps;
  return change;
}

/// Refuses a point that the edge would reach only as an island, because the other side is between it and the edge.
void refuse_islands(const DistanceField& field, const std::vector<TracePoint>& points, const FieldChange& change,
                    double reach_mm) {
  std::vector<std::uint32_t> all(points.size());
  for (std::uint32_t n = 0; n < all.size(); ++n) all[n] = n;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Distance there = field.parts().sample_nearest(points[n].place);
    if (std::abs(there.mm) < carried * reach_mm) continue;
    const double sign = there.mm > 0 ? 1 : -1;
    const auto is_cut_off = [&](const Vec3& at) {
      return sign * change.after(at, field.parts().sample_nearest(at).mm, all) > 0.1;
    };
    // In the middle of the structure the distance has no slope: no way leads to the edge.
    bool is_island = !(glm::length(there.gradient) > 0);
    for (double part = 0.1; part < 1 && !is_island; part += 0.1) {
      is_island = is_cut_off(points[n].place - part * there.mm * glm::normalize(there.gradient));
    }
    if (is_island) {
      const double needed = std::ceil(std::abs(there.mm) / carried);
      throw InvalidInput(say("trace-would-leave-an-island", n + 1, fmt::format("{:.1f}", std::abs(there.mm)),
                             fmt::format("{:.0f}", needed)));
    }
  }
}

/// The values of `mm_at` at the points, minus the wanted values.
template <typename MmAt>
Eigen::VectorXd missed(const std::vector<TracePoint>& points, const Eigen::VectorXd& wanted, const MmAt& mm_at) {
  Eigen::VectorXd mm(wanted.size());
  for (std::size_t n = 0; n < points.size(); ++n) mm[static_cast<Eigen::Index>(n)] = mm_at(points[n].place);
  return mm - wanted;
}

Field piece_traced(const Field& before, const std::vector<TracePoint>& points, double reach_mm, int threads) {
  const auto of = [](const Field& field) {
    return [&parts = field->parts()](const Vec3& at) { return parts.sample_nearest(at).mm; };
  };
  const Fit fit(points, reach_mm, false);
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(points.size()));
  Eigen::VectorXd mm = missed(points, wanted, of(before));
  FieldChange change = change_by(fit.against(mm));
  refuse_islands(*before, points, change, reach_mm);
  // Where the fit wants the points: on the edge, unless they are uncertain.
  std::vector<std::uint32_t> all(points.size());
  for (std::uint32_t n = 0; n < all.size(); ++n) all[n] = n;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const auto at = static_cast<Eigen::Index>(n);
    wanted[at] = change.after(points[n].place, mm[at], all);
  }
  // The field is interpolated between its nodes, and measured again. If the result misses the points by little, it is
  // shifted by the difference, and stays nearly a distance; otherwise it is changed once more.
  const Fit exactly(points, reach_mm, true);
  const Settle settle = [&](Patch& patch) {
    const Eigen::VectorXd left = missed(points, wanted, [&](const Vec3& at) { return measured_at(patch, at); });
    const double most = left.cwiseAbs().maxCoeff();
    if (most > well_met_mm && most < settled_mm) add_to_measured(patch, *exactly.against(left), threads);
  };
  Field field = changed(before, change, threads, settle);
  for (int round = 1; round < most_traced_rounds; ++round) {
    mm = missed(points, wanted, of(field));
    if (mm.cwiseAbs().maxCoeff() < well_met_mm) break;
    field = changed(field, change_by(exactly.against(mm)), threads, settle);
  }
  return field;
}

}  // namespace

Field traced(const Field& before, const TraceEdit& edit, int threads, EditOutcome& outcome) {
  for (std::size_t n = 0; n < edit.points_mm.size(); ++n) {
    const double mm = std::abs(before->parts().sample_nearest(edit.points_mm[n]).mm);
    if (!(mm <= edit.reach_mm)) {
      throw InvalidInput(
          say("trace-point-is-far", n + 1, fmt::format("{:.1f}", mm), fmt::format("{:g}", edit.reach_mm)));
    }
    outcome.largest_mm = std::max(outcome.largest_mm, mm);
  }
  const std::vector<TracePoint> points = thinned(edit);
  outcome.points = points.size();
  Field field = before;
  for (std::size_t first = 0; first < points.size(); first += most_of_a_piece) {
    const std::size_t end = std::min(first + most_of_a_piece, points.size());
    const auto at = [&](std::size_t n) { return points.begin() + static_cast<std::ptrdiff_t>(n); };
    std::vector<TracePoint> piece(at(first), at(end));
    // What an earlier piece has put on the edge stays there.
    for (std::size_t n = 0; n < first; ++n) {
      const bool beside = std::any_of(at(first), at(end), [&](const TracePoint& one) {
        return glm::distance(one.place, points[n].place) < edit.reach_mm;
      });
      if (beside) piece.push_back(points[n]);
    }
    field = piece_traced(field, piece, edit.reach_mm, threads);
  }
  return field;
}

}  // namespace palpate::io::internal
