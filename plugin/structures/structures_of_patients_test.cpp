/// The patient and position of a structure: names and ids as hashes, and the order of motions.

#include <gtest/gtest.h>

#include "plugin/structures/study_registrations.h"
#include "plugin/structures/study_structures.h"
#define XXH_INLINE_ALL  // xxHash's own code, not the library that the program uses
#include <xxhash.h>

#include <cstdio>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <vector>

#include "io/structures/registration.h"

namespace palpate::plugin {
namespace {

std::string marked_hash(const std::string& of) {
  char text[32];
  std::snprintf(text, sizeof text, "xxh3:%016llx", static_cast<unsigned long long>(XXH3_64bits(of.data(), of.size())));
  return text;
}

/// Servers of other versions send them: a hash is the XXH3 of the id, or of the letters of the name before any other
/// writing of it; what is empty or hashed stays.
TEST(StructuresOfPatients, IdsAndNamesAreHashedAsEverywhere) {
  EXPECT_EQ(hashed_id(""), "");
  EXPECT_EQ(hashed_name(""), "");
  EXPECT_EQ(hashed_name("^^^"), "") << "no letter";
  for (const std::string& id : std::vector<std::string>{"7", " 7", "A-12^b", "xxh3", std::string(300, 'x')}) {
    EXPECT_EQ(hashed_id(id), marked_hash(id));
    EXPECT_EQ(hashed_id(hashed_id(id)), hashed_id(id));
  }
  EXPECT_EQ(hashed_name("Doe^Jane"), marked_hash("doejane"));
  EXPECT_EQ(hashed_name("M\u00fcller 3^\u00c4nne=other=third"), marked_hash("m\u00fcller3\u00c4nne"));
  EXPECT_EQ(hashed_name(hashed_name("Doe^Jane")), hashed_name("Doe^Jane"));
}

/// A name is the same however it is written, and another with each letter that differs.
TEST(StructuresOfPatients, EveryLetterOfANameCounts) {
  const std::string name = "Zoe4^Adam";
  for (const char* const same : {"ZOE4^ADAM", "zoe4 adam", "Zoe4, Adam.", "Zoe4^Adam^^^=Zo", "^Zoe4-Adam"}) {
    EXPECT_EQ(hashed_name(same), hashed_name(name)) << same;
  }
  for (std::size_t n = 0; n < name.size(); ++n) {
    if (name[n] == '^') continue;
    std::string other = name;
    other[n] = 'q';
    EXPECT_NE(hashed_name(other), hashed_name(name)) << other;
    other.erase(n, 1);
    EXPECT_NE(hashed_name(other), hashed_name(name)) << other;
  }
}

io::RigidMotion random_motion(std::mt19937& random) {
  std::normal_distribution<double> normal;
  const glm::dvec3 axis = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  const double turned = normal(random);
  io::RigidMotion motion;
  for (int column = 0; column < 3; ++column) {  // Rodrigues' formula
    glm::dvec3 unit(0);
    unit[column] = 1;
    motion.turn[column] = std::cos(turned) * unit + std::sin(turned) * glm::cross(axis, unit) +
                          (1 - std::cos(turned)) * glm::dot(axis, unit) * axis;
  }
  motion.shift = 30.0 * glm::dvec3(normal(random), normal(random), normal(random));
  return motion;
}

/// A registration moves what was moved before; after that the structure lies in the scan's frame.
TEST(StructuresOfPatients, ARegistrationComesAfterTheMotionThatThereWas) {
  std::mt19937 random(4);
  io::Volume scan;
  scan.frame_of_reference_uid = "1.1";
  for (int n = 0; n < 20; ++n) {
    io::Structure structure;
    structure.file = "/s/rt.dcm";
    structure.frame_of_reference_uid = "1.2";
    structure.motion = random_motion(random);
    const io::RigidMotion before = structure.motion;
    io::Registration registration;
    registration.file = "/s/reg.dcm";
    registration.frame_of_reference_uid = "1.1";
    registration.parts = {{.frame_of_reference_uid = "1.2", .motion = random_motion(random), .unfit = {}}};
    const Placed placed = place_on(structure, std::vector{registration}, scan);
    ASSERT_EQ(static_cast<std::string>(placed.why_not), "");
    EXPECT_EQ(placed.registration, "/s/reg.dcm");
    EXPECT_EQ(structure.frame_of_reference_uid, "1.1");
    const glm::dvec3 at(3, -7, 11);
    const glm::dvec3 moved = before.turn * at + before.shift;
    const glm::dvec3 wanted = registration.parts[0].motion.turn * moved + registration.parts[0].motion.shift;
    EXPECT_LT(glm::distance(structure.motion(at), wanted), 1e-9);
    ASSERT_EQ(structure.warnings.size(), 1U);
    EXPECT_EQ(static_cast<std::string>(structure.warnings[0]),
              "rt.dcm lies in another frame of reference; the registration reg.dcm puts it on the scan");
    // Where it lies now, no other registration is needed.
    const io::RigidMotion there = structure.motion;
    EXPECT_TRUE(place_on(structure, {}, scan).registration.empty());
    EXPECT_EQ(structure.motion, there);
    EXPECT_TRUE(StudyRegistrations().beside(structure, scan).empty());
    // What was recorded takes the place of all that.
    const io::RigidMotion recorded = random_motion(random);
    structure.frame_of_reference_uid = "1.2";
    EXPECT_EQ(static_cast<std::string>(place_by(structure, recorded, scan)), "");
    EXPECT_EQ(structure.motion, recorded);
    EXPECT_EQ(structure.frame_of_reference_uid, "1.1");
  }
}

/// A structure of another patient is placed by nothing, and stays where it was.
TEST(StructuresOfPatients, OfAnotherPatientIsNotMoved) {
  io::Volume scan;
  scan.patient_id = "7";
  scan.frame_of_reference_uid = "1.1";
  io::Structure structure;
  structure.file = "/s/rt.dcm";
  structure.patient_id = "8";
  structure.frame_of_reference_uid = "1.2";
  std::mt19937 random(5);
  EXPECT_NE(static_cast<std::string>(place_by(structure, random_motion(random), scan)), "");
  EXPECT_EQ(structure.motion, io::RigidMotion());
  EXPECT_EQ(structure.frame_of_reference_uid, "1.2");
}

}  // namespace
}  // namespace palpate::plugin
