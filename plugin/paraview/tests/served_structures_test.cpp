// What a server tells of the structures beside its scan, and of the scan's patient, without ParaView around it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkClientServerStream.h>
#include <vtkNew.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "plugin/paraview/common/slices_message.h"
#include "plugin/paraview/common/structure_files_message.h"
#include "plugin/paraview/server/module/PalpateDicomReader.h"
#include "plugin/paraview/server/module/PalpateScanSlices.h"
#include "plugin/session/structure_files.h"
#include "plugin/testing/registered_study.h"
#include "plugin/testing/test_files.h"
#include "testdata/scan.h"
#include "testdata/write_series.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

/// Asked as a client asks, over its stream.
SlicesAnswered ask(PalpateDicomReader& reader, const SlicesAsked& asked) {
  const vtkNew<PalpateScanSlices> there, here;
  there->Asked() = asked;
  there->CopyFromObject(&reader);
  vtkClientServerStream stream;
  there->CopyToStream(&stream);
  here->CopyFromStream(&stream);
  return here->Answered();
}

TEST(ServedStructures, AreTheFilesOfTheStudyByteForByte) {
  const fs::path study = testing::fresh_path("served");
  testdata::write_series(testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(16)})),
                         study / "scan");
  testing::write_contours(study / "scan/Doe_Jane.dcm", "1.2", "7", "Doe^Jane");
  testing::write_registration(study / "registrations/reg.dcm");
  const vtkNew<PalpateDicomReader> reader;
  reader->SetFileName((study / "scan").c_str());
  reader->Update();
  const SlicesAnswered listed = ask(*reader, {.what = SlicesAsked::What::structures});
  ASSERT_EQ(listed.error, "");
  EXPECT_THAT(listed.structures, Not(HasSubstr("Jane")));
  const std::vector<ServedFile> files = served_files_of(listed.structures);
  ASSERT_EQ(files.size(), 2U) << "the contours, and the registration in the folder beside";
  for (int n = 0; n < 2; ++n) {
    const fs::path file = n == 0 ? study / "registrations/reg.dcm" : study / "scan/Doe_Jane.dcm";
    std::ifstream input(file, std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(input), {}};
    EXPECT_EQ(files[static_cast<std::size_t>(n)].hash, hash_of_file(file));
    EXPECT_EQ(files[static_cast<std::size_t>(n)].bytes, bytes.size());
    EXPECT_EQ(ask(*reader, {.what = SlicesAsked::What::structure_pieces, .frame = n, .count = 4}).bytes, bytes);
  }
  EXPECT_NE(ask(*reader, {.what = SlicesAsked::What::structure_pieces, .frame = 2, .count = 1}).error, "");
}

TEST(ServedStructures, AreNotNamedAsAnotherFolder) {
  EXPECT_ANY_THROW(served_files_of(R"([{"hash": "../../etc", "suffix": ".dcm", "bytes": 3}])"));
}

TEST(ServedStructures, TheHeadTellsFrameOfReferenceAndNoPatient) {
  const auto volume = testing::registered_scan();
  const std::string head = text_of_head(*volume);
  EXPECT_THAT(head, Not(HasSubstr("Doe")));
  EXPECT_THAT(head, Not(HasSubstr("\"7\"")));
  EXPECT_EQ(volume_of_head(head).frame_of_reference_uid, "1.1");
}

}  // namespace
}  // namespace palpate::plugin
