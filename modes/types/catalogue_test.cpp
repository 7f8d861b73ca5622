// Every mode of the catalogue places what its equation says, where it says.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "modes/scene/scene_json.h"
#include "modes/testing/test_rig.h"
#include "modes/types/mode_type.h"

namespace palpate::modes {
namespace {

using solver::PrimitiveType;
using testing::Hand;
using testing::scene_of;

/// The same everywhere, or outside everywhere.
class Uniform : public io::FieldSource {
 public:
  explicit Uniform(const io::Sample& sample) : sample_(sample) {}
  io::FieldSet available() const noexcept override { return static_cast<io::FieldSet>(63); }
  io::Sample sample(const io::Vec3&, io::FieldSet) const noexcept override { return sample_; }

 private:
  io::Sample sample_;
};

const io::Sample tissue{.inside = true,
                        .value = 100,
                        .gradient = {0, 30, 40},
                        .vector = {3, 0, -4},
                        .tube = {0, 0.6, 0.8},
                        .low = -1000,
                        .high = 120};

Mode mode_of(const char* type, Datum of, double at_datum, double strength_n) {
  Mode mode;
  mode.type = type;
  mode.strength_of = of;
  mode.strength_n = TransferFunction({{0, 0}, {at_datum, strength_n}});
  return mode;
}

/// What a mode places for a proxy at (1, 2, 3) mm.
std::vector<solver::Primitive> placed(const Mode& mode, const io::Sample& sample = tissue) {
  const Uniform source(sample);
  Hand hand(scene_of({mode}), source);
  hand.move_to({1, 2, 3});
  return {hand.result.primitives.begin(), hand.result.primitives.end()};
}

const Workspace workspace;
const Vec3 proxy = workspace.to_device({1, 2, 3});

void expect_primitive(const solver::Primitive& primitive, PrimitiveType type, double strength,
                      const Vec3& patient_direction) {
  EXPECT_EQ(primitive.type, type);
  EXPECT_DOUBLE_EQ(primitive.strength, strength);
  EXPECT_LE(glm::length(primitive.direction - workspace.direction_to_device(patient_direction)), 1e-15);
}

TEST(Catalogue, force_is_a_directed_force_along_the_field) {
  const auto all = placed(mode_of("force", Datum::vector_magnitude, 10, 2));
  ASSERT_EQ(all.size(), 1U);
  expect_primitive(all[0], PrimitiveType::directed_force, 1.0, {0.6, 0, -0.8});
  Mode uphill = mode_of("force", Datum::gradient_magnitude, 100, 2);
  uphill.direction_of = DirectionField::gradient;
  expect_primitive(placed(uphill).at(0), PrimitiveType::directed_force, 1.0, {0, 0.6, 0.8});
}

TEST(Catalogue, follow_is_a_line_along_the_field_through_the_proxy) {
  const auto all = placed(mode_of("follow", Datum::vector_magnitude, 10, 2));
  ASSERT_EQ(all.size(), 1U);
  expect_primitive(all[0], PrimitiveType::line, 1.0, {0.6, 0, -0.8});
  EXPECT_EQ(all[0].position, proxy);
}

TEST(Catalogue, surface_is_a_plane_across_the_gradient) {
  Mode surface = mode_of("surface", Datum::gradient_magnitude, 100, 2);
  const Vec3 uphill{0, 0.6, 0.8};
  auto all = placed(surface);
  ASSERT_EQ(all.size(), 1U);
  expect_primitive(all[0], PrimitiveType::plane, 1.0, -uphill);
  surface.side = Side::leaving;
  expect_primitive(placed(surface).at(0), PrimitiveType::plane, 1.0, uphill);
  surface.side = Side::both;
  all = placed(surface);
  ASSERT_EQ(all.size(), 2U);
  expect_primitive(all[0], PrimitiveType::plane, 1.0, -uphill);
  expect_primitive(all[1], PrimitiveType::plane, 1.0, uphill);
}

TEST(Catalogue, surface_between_two_tissues_is_felt_only_between_them_and_from_one_to_the_other) {
  Scene scene = scene_of({mode_of("surface", Datum::gradient_magnitude, 50, 2)});
  scene.tissues = {{"air", -2000, -400, 100, ""}, {"soft tissue", -400, 200, 100, ""}, {"bone", 200, 4000, 100, ""}};
  const auto strength = [&scene](const char* from, const char* to, double low, double high) {
    scene.modes[0].from = from;
    scene.modes[0].to = to;
    io::Sample sample = tissue;
    sample.low = low;
    sample.high = high;
    const Uniform source(sample);
    Hand hand(scene, source);
    hand.move_to({1, 2, 3});
    if (hand.result.primitives.empty()) {
      return 0.0;
    }
    // Signed: positive where going towards higher values is resisted.
    const double towards_low = -glm::dot(hand.plan.workspace.direction_to_patient(hand.result.primitives[0].direction),
                                         glm::normalize(tissue.gradient));
    return hand.result.primitives[0].strength * towards_low;
  };
  EXPECT_DOUBLE_EQ(strength("air", "soft tissue", -1000, 50), 2.0);
  EXPECT_DOUBLE_EQ(strength("soft tissue", "air", -1000, 50), -2.0);
  EXPECT_EQ(strength("air", "soft tissue", -1000, 900), 0.0);  // a sinus wall passes through soft tissue's values
  EXPECT_EQ(strength("air", "soft tissue", 50, 900), 0.0);
  EXPECT_DOUBLE_EQ(strength("air", "bone", -1000, 900), 2.0);
  EXPECT_DOUBLE_EQ(strength("bone", "soft tissue", 50, 900), -2.0);
  EXPECT_DOUBLE_EQ(strength("air", "soft tissue", -1000, 200), 1.0);  // half-way through the soft end
}

TEST(Catalogue, friction_is_a_point_at_the_proxy) {
  const auto all = placed(mode_of("friction", Datum::value, 200, 2));
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].type, PrimitiveType::point);
  EXPECT_DOUBLE_EQ(all[0].strength, 1.0);
  EXPECT_EQ(all[0].position, proxy);
}

TEST(Catalogue, tube_is_a_line_along_the_vessel) {
  const auto all = placed(mode_of("tube", Datum::value, 200, 2));
  ASSERT_EQ(all.size(), 1U);
  expect_primitive(all[0], PrimitiveType::line, 1.0, {0, 0.6, 0.8});
  EXPECT_EQ(all[0].position, proxy);
}

TEST(Catalogue, landmark_stands_at_its_own_place_also_outside_the_data) {
  Mode landmark = mode_of("landmark", Datum::value, 200, 2);
  landmark.position_mm = {10, -20, 30};
  landmark.direction = {0, 0, 5};
  for (const auto& [shape, type] : {std::pair{Shape::point, PrimitiveType::point},
                                    {Shape::line, PrimitiveType::line},
                                    {Shape::plane, PrimitiveType::plane}}) {
    landmark.shape = shape;
    const auto all = placed(landmark);
    ASSERT_EQ(all.size(), 1U);
    expect_primitive(all[0], type, 1.0, {0, 0, 1});
    EXPECT_LE(glm::length(all[0].position - workspace.to_device({10, -20, 30})), 1e-18);
  }
  landmark.strength_n = TransferFunction(0.7);
  EXPECT_EQ(placed(landmark, io::Sample{}).size(), 1U);
}

/// At the edge all of its strength, and half a margin before it half. A fifth of it pushes: 0.4 N, half of what the
/// coupling takes over 2 mm at the steepest. Where the distance has a ridge the push fades, and nothing else.
TEST(Catalogue, keep_out_and_keep_in_push_as_far_as_the_distance_has_a_direction) {
  for (const bool is_out : {true, false}) {
    Scene scene = scene_of({mode_of(is_out ? "keep_out" : "keep_in", Datum::value, 100, 2)});
    scene.structures = {{.name = "liver", .file = "a.dcm", .segment = "1"}};
    scene.modes[0].structure = "liver";
    scene.modes[0].margin_mm = 3;
    scene.subdivision.most_halts = 0;  // each would place them anew, nearer to the balance
    for (const auto& [way_mm, part] : {std::pair{-5.0, 1.0}, {0.0, 1.0}, {1.5, 0.5}, {0.75, 0.84375}}) {
      for (const double length : {0.01, 0.25, 0.5, 1.0, 1.25, 3.0}) {
        io::Sample sample = tissue;
        sample.distance[0] = {.mm = is_out ? -way_mm : way_mm, .gradient = length * Vec3(0, 0.6, 0.8)};
        const Uniform source(sample);
        Hand hand(scene, source);
        hand.move_to({1, 2, 3});
        ASSERT_EQ(hand.result.primitives.size(), 2U);
        const Vec3 away = is_out ? Vec3(0, -0.6, -0.8) : Vec3(0, 0.6, 0.8);
        const double steady = length < 1 ? length : 1;
        expect_primitive(hand.result.primitives[0], PrimitiveType::directed_force, 0.4 * part * steady, away);
        expect_primitive(hand.result.primitives[1], PrimitiveType::plane, 1.6 * part, away);
        EXPECT_EQ(hand.result.primitives[1].position, proxy);
      }
    }
  }
}

TEST(PrimitiveList, takes_what_has_strength_as_strong_as_it_is_until_it_is_full) {
  std::array<solver::Primitive, 3> room;
  std::array<std::uint8_t, 3> mode_of{};
  PrimitiveList list(room, mode_of);
  for (const double none : {0.0, -1.0, std::nan("")}) list.add(solver::make_point(none, {}));
  EXPECT_EQ(list.size(), 0U);
  list.add(solver::make_point(0.7, {1, 2, 3}));
  list.set_mode(5);
  list.set_weight(0.5);
  list.add(solver::make_point(0.6, {}));
  list.set_weight(0);
  list.add(solver::make_point(0.6, {}));
  list.set_weight(2);
  for (int n = 0; n < 3; ++n) list.add(solver::make_point(0.2 + n, {}));
  EXPECT_EQ(list.size(), 3U);
  EXPECT_EQ(room[0].strength, 0.7);
  EXPECT_EQ(room[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(room[1].strength, 0.3);
  EXPECT_EQ(room[2].strength, 0.4);
  EXPECT_EQ(mode_of, (std::array<std::uint8_t, 3>{0, 5, 5}));
}

TEST(Catalogue, nothing_is_placed_where_a_field_is_zero_or_there_is_no_data) {
  const io::Sample homogeneous{.inside = true, .value = 100};
  for (const char* type : {"force", "follow", "surface", "tube"}) {
    Mode mode = mode_of(type, Datum::value, 200, 2);
    EXPECT_EQ(placed(mode).size(), 1U) << type;
    EXPECT_EQ(placed(mode, homogeneous).size(), 0U) << type;
    EXPECT_EQ(placed(mode, io::Sample{}).size(), 0U) << type;
  }
  EXPECT_EQ(placed(mode_of("friction", Datum::value, 200, 2), io::Sample{}).size(), 0U);
}

/// As modes/README.md says.
TEST(Catalogue, AStrengthWithoutADatumIsOfTheDatumOfItsMode) {
  for (const ModeType* const type : mode_types()) {
    const std::string name(type->name);
    EXPECT_TRUE(contains(type->keys, Key::strength)) << name << ": every mode has one";
    const std::string rest = contains(type->keys, Key::margin)     ? R"(, "structure": "liver")"
                             : contains(type->keys, Key::landmark) ? R"(, "shape": "point", "position_mm": [0, 0, 0])"
                                                                   : "";
    const Scene scene = scene_from_json(
        R"({"version": 1, "structures": [{"name": "liver", "file": "liver.dcm", "segment": "liver"}], "modes": [{"type": ")" +
            name + R"(", "strength_n": 1)" + rest + "}]}",
        "test");
    const Datum expected = name == "surface"                     ? Datum::gradient_magnitude
                           : name == "follow" || name == "force" ? Datum::vector_magnitude
                                                                 : Datum::value;
    EXPECT_EQ(scene.modes.front().strength_of, expected) << name;
  }
}

/// What a mode's constraint is turned by is among the fields that it reads. No session begins where a mode is felt that
/// stands at its own place or has no direction.
TEST(Catalogue, AModeReadsWhatItIsDirectedBy) {
  for (const ModeType* const type : mode_types()) {
    for (const bool of_structure : {false, true}) {
      Mode mode;
      mode.type = std::string(type->name);
      if (of_structure) mode.structure = "liver";
      const Footprint footprint = type->footprint(mode);
      const io::FieldSet wanted = footprint.axis == Axis::structure  ? io::FieldSet::distance
                                  : footprint.axis == Axis::gradient ? io::FieldSet::gradient
                                  : footprint.axis == Axis::vector   ? io::FieldSet::vector
                                  : footprint.axis == Axis::tube     ? io::FieldSet::tube
                                                                     : io::FieldSet::none;
      EXPECT_TRUE(io::contains(type->reads(mode), wanted)) << type->name;
      EXPECT_EQ(type->finds_places, footprint.axis != Axis::own && footprint.axis != Axis::none) << type->name;
    }
  }
}

/// At a structure's edge leaving is entering seen from the other side: as strong as far on the way, the other way
/// round.
TEST(Catalogue, surface_that_is_left_mirrors_the_one_that_is_entered) {
  const auto strength = [](Side side, double inside_mm) {
    Mode mode = mode_of("surface", Datum::value, 100, 2);
    mode.structure = "liver";
    mode.side = side;
    Scene scene = scene_of({mode});
    scene.structures = {{.name = "liver", .file = "a.dcm", .segment = "1"}};
    scene.subdivision.most_halts = 0;  // each would place them anew
    io::Sample sample = tissue;
    sample.distance[0] = {.mm = inside_mm, .gradient = {0, 0.6, 0.8}};
    const Uniform source(sample);
    Hand hand(scene, source);
    hand.move_to({1, 2, 3});
    double sum = 0;
    for (const solver::Primitive& primitive : hand.result.primitives) sum += primitive.strength;
    return sum;
  };
  int felt = 0;
  for (const double way_mm : {-1.5, -1.2, -0.5, -0.05, 0.0, 0.05, 0.3, 0.6, 1.0, 1.05, 1.5}) {
    const double entered = strength(Side::entering, way_mm);
    EXPECT_NEAR(strength(Side::leaving, -way_mm), entered, 1e-12) << way_mm;
    felt += entered > 0 ? 1 : 0;
  }
  EXPECT_GE(felt, 5);
}

}  // namespace
}  // namespace palpate::modes
