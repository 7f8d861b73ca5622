/// The structure that a number or a name asks for: of files whose names are numbers, are there twice, or are missing.
#include "plugin/structures/named_structure.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "plugin/structures/scene_structures.h"
#include "plugin/testing/registered_study.h"

namespace palpate::plugin {
namespace {

io::Structure structure(int number, const std::string& name, const std::string& file = "a.dcm") {
  io::Structure one;
  one.number = number;
  one.name = name;
  one.file = file;
  return one;
}

std::string found_in(const std::vector<io::Structure>& structures, const AskedStructure& asked) {
  const FoundStructure found = find_named(structures, asked, "folder/a.dcm");
  if (found.structure == nullptr) return found.why_not;
  return std::to_string(found.structure - structures.data());
}

TEST(NamedStructures, ANumberComesBeforeANameInAnyOrder) {
  for (const bool reversed : {false, true}) {
    std::vector<io::Structure> all{structure(1, "2"), structure(2, "Liver")};
    if (reversed) std::swap(all[0], all[1]);
    EXPECT_EQ(found_in(all, asked_structure("2")), reversed ? "0" : "1");
    EXPECT_EQ(found_in(all, asked_structure("1")), reversed ? "1" : "0");
    EXPECT_EQ(found_in(all, asked_structure("Liver")), reversed ? "0" : "1");
    EXPECT_EQ(found_in(all, {.number = std::nullopt, .name = "2"}), reversed ? "1" : "0") << "a scene says which";
  }
  EXPECT_EQ(found_in({structure(1, "7"), structure(2, "Liver")}, asked_structure("7")), "0") << "no number 7";
  EXPECT_EQ(found_in({structure(1, "2a"), structure(2, "Liver")}, asked_structure("2a")), "0");
}

TEST(NamedStructures, SeveralOfANameAreRefusedWithTheirNumbers) {
  const std::vector<io::Structure> all{structure(1, "Lesion"), structure(2, "Liver"), structure(5, "Lesion")};
  EXPECT_EQ(found_in(all, asked_structure("Lesion")),
            "a.dcm holds several structures \"Lesion\": name one by its number, or its file; there are: 1 Lesion, 5 "
            "Lesion");
  EXPECT_EQ(found_in(all, asked_structure("5")), "2");
  EXPECT_EQ(found_in({structure(1, "Lesion"), structure(1, "Lesion", "b.dcm")}, asked_structure("1")),
            "a.dcm holds several structures \"1\": name one by its number, or its file; there are: 1 Lesion (a.dcm), 1 "
            "Lesion (b.dcm)");
  EXPECT_EQ(found_in(all, asked_structure("Spleen")),
            "a.dcm has no \"Spleen\"; there are: 1 Lesion, 2 Liver, 5 Lesion");
}

// A scene names one of several.
TEST(NamedStructures, OfASceneAreRefusedWhereSeveralAreMeant) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile((folder / "rt.dcm").c_str()).good());
  DcmItem& roi = testing::new_item(*file.getDataset(), DCM_StructureSetROISequence);
  roi.putAndInsertString(DCM_ROINumber, "4");
  roi.putAndInsertString(DCM_ROIName, "Cube");
  ASSERT_TRUE(file.saveFile((folder / "rt.dcm").c_str()).good());
  modes::Plan plan;
  plan.structures = {0};
  modes::Scene scene = testing::scene_of(folder / "rt.dcm");
  scene.structures[0].segment = "Cube";
  try {
    load_structures(scene, plan, *testing::registered_scan(), {});
    FAIL() << "loaded";
  } catch (const std::exception& error) {
    EXPECT_EQ(error.what(), std::string("structure \"cube\": rt.dcm holds several structures \"Cube\": name one by its "
                                        "number, or its file; there are: 1 Cube, 4 Cube"));
  }
  scene.structures[0].segment_number = 1;
  EXPECT_EQ(load_structures(scene, plan, *testing::registered_scan(), {}).size(), 1U);
}

}  // namespace
}  // namespace palpate::plugin
