// Structures on a scan: patient, frame of reference, and the effect of a registration in their study.
#include "plugin/structures/study_structures.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "plugin/messages/messages.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using io::internal::TestFolder;
using testing::scene_of;
using testing::write_contours;
using testing::write_registration;

/// What is said of it, and a distance 2 mm from its edge where the registration puts it.
std::string felt(const fs::path& file) {
  const auto volume = testing::registered_scan();
  const modes::Scene scene = scene_of(file);
  try {
    const PreparedScene prepared = prepare(scene, volume, glm::dvec3(0.1));
    EXPECT_EQ(prepared.structures.size(), 1U);
    EXPECT_NEAR(prepared.structures.at(0).distance->sample({92, 0, 9}).mm, 2, 0.15);
    EXPECT_NEAR(prepared.structures.at(0).distance->sample({88, 0, 9}).mm, -2, 0.15);
    std::string all;
    for (const Text& warning : prepared.structures[0].warnings) all += warning;
    return all;
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(StudyStructures, AreJoinedByARegistrationOfTheirStudy) {
  const TestFolder study;
  write_contours(study.path() / "1" / "rt.dcm", "1.2", "7", "Doe^Jane");
  EXPECT_EQ(felt(study.path() / "1" / "rt.dcm"),
            "structure \"cube\": rt.dcm lies in another frame of reference than the scan: choose one that was outlined "
            "on this study");
  constexpr const char* registered =
      "rt.dcm lies in another frame of reference; the registration reg.dcm puts it on the scan";
  write_registration(study.path() / "2" / "reg.dcm");
  EXPECT_EQ(felt(study.path() / "1" / "rt.dcm"), registered) << "in another series' folder";
  fs::rename(study.path() / "2" / "reg.dcm", study.path() / "1" / "reg.dcm");
  EXPECT_EQ(felt(study.path() / "1" / "rt.dcm"), registered) << "in its own folder";
}

// The scan begins at 60 mm, and the contours end at 10 mm.
TEST(StudyStructures, OffTheScanAreSaidToBe) {
  const TestFolder folder;
  write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  const auto scan = std::make_shared<io::Volume>(*testing::registered_scan());
  constexpr const char* off =
      "rt.dcm: \"Cube\" lies wholly outside the scan: choose one that was outlined on this scan";
  const auto said = [&] {
    const PreparedScene prepared = prepare(scene_of(folder / "rt.dcm"), scan, glm::dvec3(0.1));
    std::string all;
    for (const Text& warning : prepared.structures.at(0).warnings) all += warning;
    return all;
  };
  EXPECT_EQ(said(), off);
  for (io::Vec3& position : scan->geometry.slice_positions) position.x = 9;
  EXPECT_EQ(said(), "");
}

/// What is said of a structure of that patient that lies where it should.
std::string said_of(const std::string& id, const std::string& name, const io::Volume& scan) {
  const TestFolder folder;
  write_contours(folder / "rt.dcm", "1.1", id, name);
  io::Structure structure = io::find_structures(std::array{folder.path()}).structures.at(0);
  const Text why_not = place_on(structure, {}, scan).why_not;
  if (!why_not.empty()) return why_not;
  return structure.warnings.empty() ? "" : std::string(structure.warnings.front());
}

/// The same on the scan, and on one that a server has sent: of whose patient it tells hashes.
std::string said_of(const std::string& id, const std::string& name) {
  const auto scan = testing::registered_scan();
  io::Volume sent = *scan;
  sent.patient_id = hashed_id(scan->patient_id);
  sent.patient_name = hashed_name(scan->patient_name);
  const std::string said = said_of(id, name, *scan);
  EXPECT_EQ(said_of(id, name, sent), said);
  return said;
}

/// One that a scene has is not added again, and another of the same name gets the next number.
TEST(StudyStructures, HaveANameOfTheirOwnInAScene) {
  modes::Scene scene;
  scene.structures = {{.name = "mine", .file = "/s/a.dcm", .segment = "Liver"},
                      {.name = "other", .file = "/s/a.dcm", .segment = "Aorta", .segment_number = 4}};
  const auto named = [&](const std::string& file, int number, const std::string& name) {
    io::Structure structure;
    structure.file = file;
    structure.number = number;
    structure.name = name;
    return name_in_scene(scene, structure);
  };
  EXPECT_EQ(named("/s/a.dcm", 3, "Liver"), "mine");
  EXPECT_EQ(named("/s/a.dcm", 4, "anything"), "other") << "its number counts";
  EXPECT_EQ(named("/s/b.dcm", 3, "Liver"), "Liver");
  EXPECT_EQ(named("/s/c.dcm", 3, "Liver"), "Liver 2");
  EXPECT_EQ(named("/s/d.dcm", 3, "Liver"), "Liver 3");
  EXPECT_EQ(named("/s/d.dcm", 3, "Liver"), "Liver 3") << "it is there already";
  EXPECT_EQ(named("/s/d.dcm", 5, ""), "structure");
  EXPECT_EQ(scene.structures.size(), 6U);
}

/// Its widest margin outside; what keeps in has its margin inside, and what is switched off has none.
TEST(StudyStructures, WhatKeepsOutOfOneIsKnownByItsWidestMargin) {
  io::Structure aorta;
  aorta.file = "/s/a.dcm";
  aorta.number = 4;
  aorta.name = "Aorta";
  modes::Scene scene;
  EXPECT_FALSE(keep_out_of(scene, aorta));
  add_boundary_of(scene, aorta);
  EXPECT_FALSE(keep_out_of(scene, aorta)) << "a boundary keeps nothing out";
  add_keep_out_of(scene, aorta, 9);
  scene.modes.back().type = "keep_in";
  EXPECT_FALSE(keep_out_of(scene, aorta));
  add_keep_out_of(scene, aorta, 3);
  add_keep_out_of(scene, aorta, 2);
  EXPECT_EQ(keep_out_of(scene, aorta), 3);
  scene.modes[2].enabled = false;
  EXPECT_EQ(keep_out_of(scene, aorta), 2);
  io::Structure other = aorta;
  other.number = 5;
  EXPECT_FALSE(keep_out_of(scene, other));
}

TEST(StudyStructures, OfAnotherPatientAreRefused) {
  constexpr const char* another =
      "rt.dcm was outlined on another patient than the scan's: choose one that was outlined on this study";
  EXPECT_EQ(said_of("8", "Roe^Richard"), another);
  EXPECT_EQ(said_of("8", ""), another);
  constexpr const char* by_name =
      "rt.dcm names another patient than the scan, and no patient id shows that they are the same patient: choose one "
      "that was outlined on "
      "this study, or correct its name or id";
  EXPECT_EQ(said_of("", "Roe^Richard"), by_name);
  const TestFolder folder;
  write_contours(folder / "rt.dcm", "1.1", "8", "Roe^Richard");
  EXPECT_EQ(felt(folder / "rt.dcm"), std::string("structure \"cube\": ") + another);
}

TEST(StudyStructures, ThatCannotBeFeltAreRefusedByFileAndName) {
  io::Structure structure;
  structure.file = "study/rt.dcm";
  structure.kind = io::StructureKind::contours;
  structure.name = "Aorta";
  structure.unfit = say("file-holds-no-structures", "a", "b");  // any reason
  EXPECT_EQ(place_on(structure, {}, *testing::registered_scan()).why_not,
            "rt.dcm: RTSTRUCT \"Aorta\": a holds no structuresb");
}

TEST(StudyStructures, OfAPatientOfAnotherNameOrIdAreWarnedOf) {
  constexpr const char* perhaps =
      "rt.dcm calls the scan's patient by another name or id: check in the views that it lies in the right place";
  EXPECT_EQ(said_of("8", "Doe^Jane"), perhaps);
  EXPECT_EQ(said_of("7", "Roe^Jane"), perhaps);
}

TEST(StudyStructures, OfThePatientAreFeltInSilence) {
  EXPECT_EQ(said_of("7", "Doe^Jane"), "");
  EXPECT_EQ(said_of("7", "DOE^JANE^^^"), "");
  EXPECT_EQ(said_of("7", "Doe^Jane=Do^Jan"), "");
  EXPECT_EQ(said_of("", ""), "") << "nothing is said of who it is";
}

/// A structure's distances reach a millimeter beyond all that the scene makes of them, so that nothing ends abruptly;
/// in steps, so that a margin that is dragged does not ask for new ones each time.
TEST(StudyStructures, TheirDistancesReachBeyondAllThatIsMadeOfThem) {
  const TestFolder folder;
  write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  const auto volume = std::make_shared<io::Volume>(*testing::registered_scan());
  for (io::Vec3& position : volume->geometry.slice_positions) position.x = -40;
  const modes::Scene plain = scene_of(folder / "rt.dcm");
  const auto reach = [&](const auto& edit) {
    modes::Scene scene = plain;
    edit(scene);
    return prepare(scene, volume, glm::dvec3(0.1)).structures.at(0).distance->reach_mm();
  };
  const auto gate = [](const std::string& of, std::vector<modes::Node> nodes) {
    modes::Gate made;
    made.of = modes::Datum::distance;
    made.structure = of;
    made.factor = modes::TransferFunction(std::move(nodes));
    return made;
  };
  EXPECT_EQ(reach([](modes::Scene&) {}), 5) << "its edge, with the margin of 3 mm that a mode has by itself";
  EXPECT_EQ(reach([](modes::Scene& scene) { scene.modes[0].level_mm = -6.5; }), 12);
  EXPECT_EQ(reach([](modes::Scene& scene) { scene.structures[0].margin_mm = 7; }), 8) << "just enough";
  EXPECT_EQ(reach([&](modes::Scene& scene) { scene.modes[0].gates = {gate("cube", {{-7.5, 0}, {2, 1}})}; }), 12);
  const auto of_another = [&](modes::Scene& scene) {
    scene.structures.push_back(scene.structures[0]);
    scene.structures[1].name = "other";
    scene.modes[0].gates = {gate("other", {{-7.5, 0}, {2, 1}})};
  };
  EXPECT_EQ(reach(of_another), 5);
}

}  // namespace
}  // namespace palpate::plugin
