/// Laws of the certificate, against balances whose exact proxy is known because they are built around it: the proxy and
/// an admissible force of each primitive are chosen first, the probe is then where these forces balance.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "solver/certify.h"
#include "solver/testing/problems.h"

namespace palpate::solver {
namespace {

constexpr double stiffness = 400;

struct Known {
  std::vector<Primitive> primitives;
  std::vector<Vec3> forces;  ///< N: those of the exact balance
  Vec3 proxy{0};
  Vec3 probe{0};

  Balance balance() const { return {stiffness, probe, proxy, primitives}; }
};

Vec3 across(const Vec3& direction, Random& random) {
  const Vec3 other = random.unit_vector();
  return glm::normalize(other - direction * glm::dot(direction, other));
}

/// Adds a primitive and what it exerts at the proxy: pushing, idle or, where it holds the proxy, anything it can.
void add(Known& known, Random& random) {
  const double strength = random.log_uniform(0.05, 3);
  const Vec3 direction = random.unit_vector();
  const bool holds = random.below(2) == 0;
  const double far = random.log_uniform(1e-4, 5e-3);
  switch (random.below(4)) {
    case 0:
      known.primitives.push_back(make_directed_force(strength, direction));
      known.forces.push_back(direction * strength);
      break;
    case 1: {
      const bool behind = random.below(2) == 0;
      const Vec3 aside = across(direction, random) * far;
      const Vec3 position = known.proxy + aside + (holds ? Vec3(0) : direction * (behind ? far : -far));
      known.primitives.push_back(make_plane(strength, position, direction));
      known.forces.push_back(direction * (holds ? random.uniform(0, strength) : behind ? strength : 0));
      break;
    }
    case 2: {
      const Vec3 aside = across(direction, random);
      const Vec3 along = direction * random.uniform(-far, far);
      known.primitives.push_back(make_line(strength, known.proxy + along + (holds ? Vec3(0) : aside * far), direction));
      known.forces.push_back(aside * (holds ? random.uniform(0, strength) : strength));
      break;
    }
    default: {
      const Vec3 towards = random.unit_vector();
      known.primitives.push_back(make_point(strength, known.proxy + (holds ? Vec3(0) : towards * far)));
      known.forces.push_back(towards * (holds ? random.uniform(0, strength) : strength));
    }
  }
}

Known make_known(std::uint64_t seed) {
  Random random(seed);
  Known known;
  known.proxy = random.normal_vector(0.03);
  const std::size_t count = 1 + random.below(4);
  for (std::size_t n = 0; n < count; ++n) add(known, random);
  Vec3 sum(0);
  for (const Vec3& force : known.forces) sum += force;
  known.probe = known.proxy - sum / stiffness;
  return known;
}

/// The bound that the residual and the slack of a certificate give, m.
double law_of(const Certificate& certificate) {
  const double r = certificate.residual;
  return (r + std::sqrt(r * r + 4 * stiffness * certificate.slack)) / (2 * stiffness);
}

// Rounding of a constructed balance: coordinates of 0.1 m and forces of 10 N over k.
constexpr double rounding = 1e-15;

TEST(CertifyLaws, TheBoundOfTheExactProxyAndItsForcesIsNothing) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Known known = make_known(seed);
    const double bound = certify(known.balance(), known.proxy, known.forces).error_bound;
    // Slack of the rounding of a distance costs its root: |x - x*|^2 <= eps / k.
    EXPECT_LE(bound, 1e-8) << seed;
  }
}

/// What anybody may have for an answer: the proxy moved, the forces as they were, at random, or such that the residual
/// is small, where the slack alone has to pay.
TEST(CertifyLaws, NoBoundIsBelowTheDistanceToTheKnownProxy) {
  double tightest = 1e9;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    const Known known = make_known(seed);
    Random random(seed + 1000000);
    for (const double size : {5e-3, 1e-3, 1e-4, 1e-6}) {
      const Vec3 guess = known.proxy + random.unit_vector() * size;
      std::vector<Vec3> forces = known.forces;
      switch (random.below(3)) {
        case 0:
          break;
        case 1:
          for (Vec3& force : forces) force = random.normal_vector(1);
          break;
        default: {
          const Vec3 missing = stiffness * (guess - known.proxy);
          for (Vec3& force : forces) force += missing / static_cast<double>(forces.size());
        }
      }
      const double bound = certify(known.balance(), guess, forces).error_bound;
      const double error = glm::length(guess - known.proxy);
      ASSERT_GE(bound, error - rounding) << seed << ", " << known.primitives.size() << " primitives";
      tightest = std::min(tightest, bound / error);
    }
  }
  EXPECT_LT(tightest, 1.001) << "the law is attained: a smaller constant in it would have been seen";
}

/// Where the true proxy lies on the primitive, the proxy given is d away and the primitive's force lacks what that
/// costs: the residual is nothing, the slack k d^2, and the bound the distance, for any split between the two. So
/// whoever weighs slack against residual wrongly is below it or above.
TEST(CertifyLaws, SlackAloneGivesTheDistanceExactly) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const double strength = random.uniform(0.5, 2);
    const double d = random.uniform(1e-4, 0.9 * strength / stiffness);
    const Vec3 direction = random.unit_vector();
    const Vec3 held = random.normal_vector(0.02);
    // The full strength pushes at the place that holds; the guess lies d behind it and claims so much less.
    const std::array forces{direction * (strength - stiffness * d)};
    const Vec3 probe = held - direction * (strength / stiffness);
    const Vec3 guess = held - direction * d;
    for (const Primitive& primitive : {make_plane(strength, held, direction), make_point(strength, held),
                                       make_line(strength, held, across(direction, random))}) {
      const std::array primitives{primitive};
      const Certificate certificate = certify({stiffness, probe, held, primitives}, guess, forces);
      EXPECT_GE(certificate.error_bound, d - rounding) << name_of(primitive.type) << " " << seed;
      EXPECT_LE(certificate.error_bound, d * (1 + 1e-6) + rounding) << name_of(primitive.type) << " " << seed;
      EXPECT_NEAR(law_of(certificate), d, 1e-6 * d + rounding) << name_of(primitive.type) << " " << seed;
    }
  }
}

/// The residual and the slack are those of the bound, wherever it was evaluated: the way to that place comes on top.
TEST(CertifyLaws, TheBoundIsNotBelowTheLawOfItsResidualAndSlack) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Known known = make_known(seed);
    Random random(seed + 2000000);
    for (const double size : {5e-3, 1e-4, 1e-6}) {
      const Certificate certificate = certify(known.balance(), known.proxy + random.unit_vector() * size, known.forces);
      EXPECT_GE(certificate.error_bound, law_of(certificate) * (1 - 1e-9)) << seed;
    }
  }
}

/// In a balance whose directions are well apart, data within 4 ulp have their proxy within nanometers: the bound for
/// the most favorable of them is not below the distance to the known proxy either.
TEST(CertifyLaws, RoundingOfTheDataExplainsNoDistanceThatCanBeFelt) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Known known = make_known(seed);
    Random random(seed + 3000000);
    for (const double size : {5e-3, 1e-3, 1e-4, 1e-5}) {
      const Certificate certificate = certify(known.balance(), known.proxy + random.unit_vector() * size, known.forces);
      EXPECT_GE(certificate.backward_bound, 0.999 * size) << seed;
      EXPECT_LE(certificate.backward_bound, certificate.error_bound * (1 + 1e-9)) << seed;
    }
  }
}

/// Friction that has just slipped: a point pulls with all its strength from next to nothing away, on a plane that
/// holds. The answer is exact, and the certificate says so, whatever the rounding of what lies on the plane.
TEST(CertifyLaws, AnExactAnswerNextToSlippingIsCertified) {
  int tight = 0, tried = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const Vec3 normal = random.unit_vector(), along = across(normal, random);
    const Vec3 anchor = random.normal_vector(0.02);
    const double friction = random.uniform(0.1, 1), surface = random.uniform(1, 2),
                 away = random.log_uniform(1e-9, 1e-6);
    const Vec3 proxy = anchor + along * away;
    const std::array primitives{make_plane(surface, anchor, normal), make_point(friction, anchor)};
    const std::array forces{normal * (0.5 * surface), along * -friction};
    const Vec3 probe = proxy - (forces[0] + forces[1]) / stiffness;
    const Balance balance{stiffness, probe, anchor, primitives};
    const Certificate certificate = certify(balance, proxy, forces);

    ++tried;
    tight += certificate.error_bound <= 20 * promised_accuracy(balance, proxy, forces) ? 1 : 0;
  }
  EXPECT_EQ(tight, tried);
}

/// Of a free proxy the residual alone speaks: bound = r / k, and the numbers that are told are r and no slack.
TEST(CertifyLaws, ResidualAloneIsTheForceThatIsMissing) {
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    Random random(seed);
    const std::array primitives{make_directed_force(random.uniform(0.1, 2), random.unit_vector())};
    const Vec3 force = primitives[0].direction * primitives[0].strength;
    const Vec3 probe = random.normal_vector(0.02);
    const Vec3 off = random.unit_vector() * random.log_uniform(1e-6, 1e-2);
    const std::array forces{force};
    const Certificate certificate =
        certify({stiffness, probe, probe, primitives}, probe + force / stiffness + off, forces);
    EXPECT_NEAR(certificate.error_bound, glm::length(off), 1e-15);
    EXPECT_NEAR(certificate.residual, stiffness * glm::length(off), 1e-12);
    EXPECT_EQ(certificate.slack, 0);
  }
}

}  // namespace
}  // namespace palpate::solver
