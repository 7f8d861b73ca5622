// A server's messages about the structures beside its scan, and about the scan's patient, without ParaView.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <vtkClientServerStream.h>
#include <vtkNew.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "io/structures/structure.h"
#include "modes/scene/starting_scene.h"
#include "plugin/paraview/server/module/PalpateDicomReader.h"
#include "plugin/paraview/server/module/PalpateScanSlices.h"
#include "plugin/paraview/wire/slices_message.h"
#include "plugin/paraview/wire/structure_files_message.h"
#include "plugin/structures/structure_files.h"
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
  there->asked() = asked;
  there->CopyFromObject(&reader);
  vtkClientServerStream stream;
  there->CopyToStream(&stream);
  here->CopyFromStream(&stream);
  return here->answered();
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
  const std::vector<ServedFile> files = served_files_of(listed.structures);
  ASSERT_EQ(files.size(), 2U) << "the contours, and the registration in the folder beside";
  for (int n = 0; n < 2; ++n) {
    const fs::path file = n == 0 ? study / "registrations/reg.dcm" : study / "scan/Doe_Jane.dcm";
    std::ifstream input(file, std::ios::binary);
    const std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(input), {}};
    EXPECT_EQ(files[static_cast<std::size_t>(n)].path, file);
    EXPECT_EQ(files[static_cast<std::size_t>(n)].hash, hash_of_file(file));
    EXPECT_EQ(files[static_cast<std::size_t>(n)].bytes, bytes.size());
    EXPECT_EQ(ask(*reader, {.what = SlicesAsked::What::structure_pieces, .frame = n, .count = 4}).bytes, bytes);
  }
  EXPECT_NE(ask(*reader, {.what = SlicesAsked::What::structure_pieces, .frame = 2, .count = 1}).error, "");
}

TEST(ServedStructures, AreNotNamedAsAnotherFolder) {
  const auto text = [](const std::string& path) { return R"([{"hash": "0", "path": ")" + path + R"(", "bytes": 3}])"; };
  EXPECT_EQ(places_of(served_files_of(text("/a/../etc/passwd"))), std::vector<fs::path>{"0/passwd"});
  for (const char* const path : {"/a/..", "/a/.", "/a/", ""}) EXPECT_ANY_THROW(served_files_of(text(path))) << path;
}

TEST(ServedStructures, OfOneFolderAreBesideEachOther) {
  EXPECT_EQ(places_of({{.hash = {}, .path = "/a/labels.mhd"},
                       {.hash = {}, .path = "/b/labels.mhd"},
                       {.hash = {}, .path = "/a/labels.raw"}}),
            (std::vector<fs::path>{"0/labels.mhd", "1/labels.mhd", "0/labels.raw"}));
}

// Two kinds of headers with their voxels beside them: all four come, and are read where they came to.
TEST(ServedStructures, ComeWithTheVoxelsBesideThem) {
  const fs::path study = testing::fresh_path("detached");
  testdata::write_series(testdata::scan(testdata::make_sphere(5), testdata::make_geometry({.size = glm::ivec3(16)})),
                         study / "scan");
  std::ofstream(study / "scan/a.mhd")
      << "NDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nElementDataFile = a.raw\n";
  std::ofstream(study / "scan/b.nhdr") << "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\n"
                                          "sizes: 4 4 4\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\n"
                                          "space origin: (0,0,0)\ndata file: b.raw\n";
  for (const char* const raw : {"a.raw", "b.raw"}) std::ofstream(study / "scan" / raw) << std::string(64, '\1');
  const vtkNew<PalpateDicomReader> reader;
  reader->SetFileName((study / "scan").c_str());
  reader->Update();
  const std::vector<ServedFile> files =
      served_files_of(ask(*reader, {.what = SlicesAsked::What::structures}).structures);
  ASSERT_EQ(files.size(), 4U);
  const fs::path client = testing::fresh_path("fetched");
  const std::vector<fs::path> places = places_of(files);
  for (int n = 0; n < 4; ++n) {
    const fs::path place = client / places[static_cast<std::size_t>(n)];
    fs::create_directories(place.parent_path());
    const auto bytes = ask(*reader, {.what = SlicesAsked::What::structure_pieces, .frame = n, .count = 4}).bytes;
    std::ofstream(place, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  const auto found = io::find_structures(std::array{client}).structures;
  ASSERT_EQ(found.size(), 2U);
  for (const io::Structure& structure : found) EXPECT_EQ(io::measure(structure).voxels, 64U) << structure.file;
}

TEST(ServedStructures, TheHeadTellsFrameOfReferenceAndNoPatient) {
  const auto volume = testing::registered_scan();
  const std::string head = text_of_head(*volume);
  EXPECT_THAT(head, Not(HasSubstr("Doe")));
  EXPECT_THAT(head, Not(HasSubstr("\"7\"")));
  EXPECT_EQ(volume_of_head(head).frame_of_reference_uid, "1.1");
}

/// A scan from a server opens with the scene that it opens with from a folder; of its description only the word that
/// names a part of the body is told.
TEST(ServedStructures, TheHeadTellsThePartOfTheBody) {
  io::Volume volume = *testing::registered_scan();
  for (const auto& [body_part, description] :
       {std::pair{"CHEST", ""}, {"", "Thorax of J. Roe"}, {"FOOT", "LWS"}, {"", "routine, J. Roe"}}) {
    volume.body_part = body_part;
    volume.description = description;
    const std::string head = text_of_head(volume);
    EXPECT_THAT(head, Not(HasSubstr("Roe")));
    EXPECT_EQ(modes::starting_scene(volume_of_head(head)), modes::starting_scene(volume)) << description;
  }
}

}  // namespace
}  // namespace palpate::plugin
