// The server plug-in's messages about scans, images and requests that it refuses, as in messages.md: the reader, the
// filters and the transfer of slices to a client, without ParaView.

#include <gtest/gtest.h>
#include <vtkClientServerStream.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkStringOutputWindow.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "io/messages.h"
#include "io/series.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/server/module/PalpateDicomReader.h"
#include "plugin/paraview/server/module/PalpateFields.h"
#include "plugin/paraview/server/module/PalpateScanSlices.h"
#include "plugin/paraview/wire/slices_message.h"
#include "plugin/testing/test_files.h"
#include "solver/text/testing/shown.h"
#include "testdata/scan.h"
#include "testdata/write_series.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

void expect_row(const std::string& row, const std::string& said) {
  const auto is_it = [&](const Message& message) { return message.text == row; };
  const auto holds = [&](const MessageRow& one) { return std::ranges::any_of(one.messages, is_it); };
  EXPECT_TRUE(std::ranges::any_of(messages::paraview, holds) || std::ranges::any_of(io::messages::series, holds))
      << "no row of the tables: " << row;
  EXPECT_TRUE(palpate::testing::fits(row, said)) << "wanted: " << row << "\nsaid: " << said;
}

/// A ball as a series; `lattice` may make it odd.
fs::path ball(const std::string& name, const std::function<void(testdata::Grid&)>& lattice = {}) {
  const auto folder = testing::fresh_path(name);
  testdata::Grid settings{.size = glm::ivec3(16)};
  if (lattice) lattice(settings);
  testdata::write_series(testdata::scan(testdata::make_sphere(5), testdata::make_geometry(settings)), folder);
  return folder;
}

/// What VTK is told meanwhile.
std::string told(const std::function<void()>& run) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  const vtkNew<vtkStringOutputWindow> window;
  const vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  vtkOutputWindow::SetInstance(window);
  run();
  vtkOutputWindow::SetInstance(before);
  return window->GetOutput();
}

std::string said_of(const fs::path& file, const std::string& uid = "") {
  return told([&] {
    const vtkNew<PalpateDicomReader> reader;
    reader->SetFileName(file.c_str());
    reader->SetSeriesUid(uid.c_str());
    reader->Update();
    for (vtkIdType n = 0; n < reader->GetMessages()->GetNumberOfValues(); ++n) {
      vtkOutputWindow::GetInstance()->DisplayText(reader->GetMessages()->GetValue(n).c_str());
    }
  });
}

std::string fields_of(vtkImageData& image, const std::string& mode = "") {
  return told([&] {
    const vtkNew<PalpateFields> fields;
    fields->SetInputData(&image);
    fields->SetScene("ct-skin-and-bone");
    fields->SetMode(mode.c_str());
    fields->Update();
  });
}

std::string refusal_of_head(const std::string& text) {
  try {
    volume_of_head(text);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

TEST(ServerMessages, TheReaderSaysWhyThereIsNoScan) {
  const fs::path scan = ball("scan");
  const fs::path letter = testing::fresh_path("letters") / "letter.txt";
  fs::create_directory(letter.parent_path());
  std::ofstream(letter) << "This is no scan.";
  expect_row("{}: no series {}; there is:{}", said_of(scan, "1.2.3"));
  expect_row("{}: no series that is a volume; there is:{}", said_of(letter.parent_path()));
  expect_row("no image among {} files; the first, {}: {}", said_of(letter.parent_path()));
  expect_row("{} is not part of a series; there is:{}", said_of(letter));
  const fs::path cut = ball("cut");
  const std::string uid = io::find_series(std::array{cut}).series.front().uid;
  for (const auto& file : fs::directory_iterator(cut)) fs::resize_file(file.path(), fs::file_size(file.path()) - 10);
  expect_row("none of its images can be read", said_of(cut, uid));
}

TEST(ServerMessages, TheReaderSaysHowAScanIsShown) {
  expect_row("slices are unevenly spaced: the display is resampled, touch is not",
             said_of(ball("uneven", [](auto& lattice) { lattice.uneven_mm = 0.2; })));
  expect_row(
      "this scan is oblique or tilted: ParaView's Contour, Clip, Iso Volume and Resample To Image can misplace it by "
      "centimeters; use Palpate's Tissue Surface",
      said_of(ball("tilted", [](auto& lattice) { lattice.tilt_degrees = 20; })));
}

TEST(ServerMessages, TheFieldsSayWhatIsNoScanAndWhatIsNoMode) {
  const vtkNew<vtkImageData> image;
  image->SetDimensions(8, 8, 8);
  expect_row("the image has no point scalars: put the filter on the scan's reader", fields_of(*image));
  const vtkNew<vtkFloatArray> vectors;
  vectors->SetName("v");
  vectors->SetNumberOfComponents(3);
  vectors->SetNumberOfTuples(512);
  vectors->Fill(0);
  image->GetPointData()->SetScalars(vectors);
  expect_row("{} has several components; a scan has one value a point: choose another array", fields_of(*image));
  const vtkNew<vtkShortArray> values;
  values->SetName("HU");
  values->SetNumberOfTuples(512);
  values->Fill(0);
  image->GetPointData()->SetScalars(values);
  EXPECT_EQ(fields_of(*image), "");
  expect_row("the scene has no mode named \"{}\"; leave Mode empty for all that hold the stylus",
             fields_of(*image, "absent"));
}

TEST(ServerMessages, WhatIsNoAnswerIsRefused) {
  expect_row("what the server says of the scan cannot be read: {}", refusal_of_head("{"));
  const std::string head =
      R"({"geometry": {"dimensions": [4, 4, 9], "direction_i": [1, 0, 0], "direction_j": [0, 1, 0], "spacing": [1, 1],)"
      R"( "slice_positions": [[0, 0, 0]], "step": [0, 0, 1], "uniform": true, "gaps": []}})";
  expect_row("a size that no scan has", refusal_of_head(head));
}

TEST(ServerMessages, SlicesThatCannotBeHadAreRefused) {
  const vtkNew<PalpateScanSlices> slices;
  slices->CopyFromObject(nullptr);
  expect_row("the server has not opened the scan", slices->answered().error);
  const vtkNew<PalpateDicomReader> reader;
  reader->SetFileName(ball("slices").c_str());
  reader->Update();
  slices->asked() = {.what = SlicesAsked::What::hashes, .first = 14, .count = 9};
  slices->CopyFromObject(reader);
  expect_row("the scan has no such slices", slices->answered().error);
  slices->asked() = {.what = SlicesAsked::What::structure_pieces, .frame = 0, .count = 1};
  slices->CopyFromObject(reader);
  expect_row("the server has no such file of structures any more", slices->answered().error);
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Reply << 3 << vtkClientServerStream::End;
  slices->CopyFromStream(&stream);
  expect_row("the server runs another version of Palpate: it needs the version of this program",
             slices->answered().error);
}

}  // namespace
}  // namespace palpate::plugin
