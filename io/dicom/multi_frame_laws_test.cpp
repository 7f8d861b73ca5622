// Files of several frames: what distinguishes frames at one position, and that each frame has its own pixels.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr int law_columns = 6, law_rows = 4;

/// Frame f has the values 1000 f + 10 i + j.
std::vector<Uint16> pixels_of(std::size_t frames) {
  std::vector<Uint16> pixels;
  for (std::size_t f = 0; f < frames; ++f) {
    for (int n = 0; n < law_columns * law_rows; ++n) {
      pixels.push_back(static_cast<Uint16>(1000 * static_cast<int>(f) + 10 * (n % law_columns) + n / law_columns));
    }
  }
  return pixels;
}

void put_pixels(DcmDataset& dataset, const std::vector<Uint16>& pixels) {
  succeed(dataset.putAndInsertUint16Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(pixels.size())));
}

/// An attribute of an enhanced file that tells frames apart, two values of it, and the names that the volumes of these
/// have, in order: numbers ascend, words are in the order of the file.
struct Telling {
  std::function<void(DcmItem&, int)> put;  ///< in a frame's functional groups, its first or its second value
  std::array<const char*, 2> names;
  std::array<int, 2> order{0, 1};  ///< which value the first and the second volume have
  std::size_t series = 1;          ///< how many the volumes are: frames of one, or two
};

void put_text(DcmItem& frame, const DcmTagKey& sequence, const DcmTagKey& tag, const char* text) {
  succeed(group(frame, sequence).putAndInsertString(tag, text));
}
void put_number(DcmItem& frame, const DcmTagKey& sequence, const DcmTagKey& tag, double number) {
  succeed(group(frame, sequence).putAndInsertFloat64(tag, number));
}

// PS3.3 C.7.6.16.2, C.8.13.5, C.8.15.3.
const std::vector<Telling>& all_that_tells() {
  static const std::vector<Telling> all{
      {[](DcmItem& frame, int n) {
         put_text(frame, DCM_FrameAnatomySequence, DCM_FrameLaterality, n == 0 ? "R" : "L");
       },
       {"side L", "side R"},
       {1, 0},
       2},
      {[](DcmItem& frame, int n) {
         put_text(frame, DCM_CTReconstructionSequence, DCM_ConvolutionKernel, n == 0 ? "B70f" : "B30f");
       },
       {"kernel B70f", "kernel B30f"}},
      {[](DcmItem& frame, int n) {
         put_text(frame, DCM_MRImageFrameTypeSequence, DCM_ComplexImageComponent, n == 0 ? "MAGNITUDE" : "PHASE");
       },
       {"MAGNITUDE", "PHASE"}},
      {[](DcmItem& frame, int n) { put_number(frame, DCM_MREchoSequence, DCM_EffectiveEchoTime, n == 0 ? 9.2 : 4.6); },
       {"echo time 4.6 ms", "echo time 9.2 ms"},
       {1, 0}},
      {[](DcmItem& frame, int n) {
         put_number(frame, DCM_MRDiffusionSequence, DCM_DiffusionBValue, n == 0 ? 1000 : 50);
       },
       {"b = 50 s/mm2", "b = 1000 s/mm2"},
       {1, 0}},
      {[](DcmItem& frame, int n) {
         DcmItem& direction = group(group(frame, DCM_MRDiffusionSequence), DCM_DiffusionGradientDirectionSequence);
         const std::array<double, 3> along{n == 0 ? 0.0 : 1.0, n == 0 ? 1.0 : 0.0, 0.0};
         succeed(direction.putAndInsertFloat64Array(DCM_DiffusionGradientOrientation, along.data(), 3));
       },
       {"direction 0 1 0", "direction 1 0 0"}},
      {[](DcmItem& frame, int n) {
         DcmItem& content = group(frame, DCM_FrameContentSequence);
         succeed(content.putAndInsertUint32(DCM_TemporalPositionIndex, n == 0 ? 12 : 3));
       },
       {"time point 3", "time point 12"},
       {1, 0}},
      {[](DcmItem& frame, int n) {
         put_number(frame, DCM_CardiacSynchronizationSequence, DCM_NominalCardiacTriggerDelayTime, n == 0 ? 300 : 40.5);
       },
       {"trigger delay 40.5 ms", "trigger delay 300 ms"},
       {1, 0}}};
  return all;
}

/// Of the frames of a file, those of one place by turns: f / 2 is the place, f % 2 which of two values it has.
void expect_two_volumes(
    const Telling& telling, const std::function<void(DcmDataset&)>& edit = [](DcmDataset&) {}) {
  SCOPED_TRACE(telling.names[0]);
  const TestFolder folder;
  TestImage image;
  image.edit = [&](DcmDataset& d) {
    make_multi_frame(d, {0, 0, 2, 2, 4, 4, 6, 6},
                     [&](std::size_t f, DcmItem& frame) { telling.put(frame, static_cast<int>(f % 2)); });
    put_pixels(d, pixels_of(8));
    edit(d);
  };
  write(image, folder / "enhanced.dcm");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(telling.series)) << (found.skipped.empty() ? Text() : found.skipped.front().reason);
  std::vector<std::string> names;
  std::vector<Volume> volumes;
  for (const Series& series : found.series) {
    for (int n = 0; n < series.frames_per_position; ++n) {
      names.push_back(series.part + series.frame_names.at(static_cast<std::size_t>(n)));
      volumes.push_back(load_frame(series, n));
    }
  }
  ASSERT_THAT(names, ElementsAre(telling.names[0], telling.names[1]));
  for (const std::size_t n : {0U, 1U}) {
    ASSERT_EQ(volumes[n].geometry.dimensions.z, 4);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(volumes[n].value_at(3, 2, k), 1000 * (2 * k + telling.order[n]) + 32) << n;
  }
}

TEST(MultiFrameLaws, WhatTellsFramesOfAPlaceApartMakesVolumesAndNamesThem) {
  for (const Telling& telling : all_that_tells()) expect_two_volumes(telling);
}

// PS3.3 C.7.6.16.2.11: a parametric map says what a frame is by the label of its mapping. The explanation is free text.
TEST(MultiFrameLaws, TheQuantitiesOfAParametricMapAreToldByTheirLabels) {
  const Telling label{[](DcmItem& frame, int n) {
                        DcmItem& mapping = group(frame, DCM_RealWorldValueMappingSequence);
                        succeed(mapping.putAndInsertFloat64(DCM_RealWorldValueSlope, 1));
                        succeed(mapping.putAndInsertFloat64(DCM_RealWorldValueIntercept, 0));
                        succeed(mapping.putAndInsertString(DCM_LUTLabel, n == 0 ? "Ktrans" : "ADC"));
                        succeed(mapping.putAndInsertString(DCM_LUTExplanation, "by the program of the scanner"));
                      },
                      {"Ktrans", "ADC"}};
  expect_two_volumes(label, [](DcmDataset& d) { put(d, DCM_SOPClassUID, UID_ParametricMapStorage); });
}

/// Heights of five slices, in the order of their frames.
const std::vector<std::vector<double>> orders{{0, 2, 4, 6, 8}, {8, 6, 4, 2, 0}, {4, 0, 8, 2, 6}};

// Whatever the order of the frames. A deflated file can only be read from its beginning on.
TEST(MultiFrameLaws, EachSliceHasThePixelsOfItsFrameInEveryUncompressedTransferSyntax) {
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    for (const std::vector<double>& heights : orders) {
      SCOPED_TRACE(std::string(DcmXfer(syntax).getXferName()) + ", first at " + std::to_string(heights.front()));
      const TestFolder folder;
      TestImage image;
      image.syntax = syntax;
      image.edit = [&](DcmDataset& d) {
        make_multi_frame(d, heights);
        put_pixels(d, pixels_of(heights.size()));
      };
      write(image, folder / "enhanced.dcm");
      const Volume volume = load(only_series_in(folder));
      EXPECT_THAT(volume.warnings, IsEmpty());
      ASSERT_EQ(volume.geometry.dimensions.z, 5);
      for (std::size_t f = 0; f < heights.size(); ++f) {
        const int k = static_cast<int>(heights[f] / 2);
        for (int n = 0; n < law_columns * law_rows; ++n) {
          const int i = n % law_columns, j = n / law_columns;
          EXPECT_EQ(volume.value_at(i, j, k), 1000 * static_cast<int>(f) + 10 * i + j) << f;
        }
      }
    }
  }
}

// Two files of one instance, alike but for a single pixel.
TEST(MultiFrameLaws, CopiesAreToldFromOnesWithOtherPixelsInWhateverFrameThese) {
  constexpr std::size_t frames = 4, of_frame = std::size_t{law_columns} * law_rows;
  const auto reason_where = [&](std::size_t pixel) {
    const TestFolder folder;
    for (const bool is_copy : {false, true}) {
      TestImage image{.instance = "1.2.3.9.1"};
      image.edit = [&](DcmDataset& d) {
        make_multi_frame(d, {0, 2, 4, 6});
        std::vector<Uint16> pixels = pixels_of(frames);
        if (is_copy && pixel < pixels.size()) ++pixels[pixel];
        put_pixels(d, pixels);
      };
      write(image, folder / (is_copy ? "b.dcm" : "a.dcm"));
    }
    const Catalogue found = find_in(folder);
    EXPECT_THAT(found.series, SizeIs(1));
    return found.skipped.size() == 1 ? std::string(found.skipped[0].reason) : "";
  };
  EXPECT_EQ(reason_where(frames * of_frame), "a copy of a.dcm: the same SOP instance");
  for (std::size_t f = 0; f < frames; ++f) {
    for (const std::size_t pixel : {f * of_frame, f * of_frame + of_frame / 2, (f + 1) * of_frame - 1}) {
      EXPECT_EQ(reason_where(pixel), "a copy of a.dcm: the same SOP instance, but with other pixels") << pixel;
    }
  }
}

// The thickness that a file states for all of its frames holds; where there is none it is that of the first frame.
TEST(MultiFrame, ThicknessIsTheFilesOrElseItsFirstFrames) {
  for (const auto& [of_file, of_first, expected] : {std::tuple{3, 5, 3}, {3, 0, 3}, {0, 5, 5}, {0, 0, 0}}) {
    const TestFolder folder;
    TestImage image;
    image.edit = [&, of_file = of_file, of_first = of_first](DcmDataset& d) {
      of_file > 0 ? put(d, DCM_SliceThickness, std::to_string(of_file))
                  : succeed(d.findAndDeleteElement(DCM_SliceThickness));
      make_multi_frame(d, {0, 4, 8}, [&](std::size_t f, DcmItem& frame) {
        if (of_first == 0) return;
        const double thickness = of_first + static_cast<double>(f);
        DcmItem& measures = group(frame, DCM_PixelMeasuresSequence);
        succeed(measures.putAndInsertString(DCM_SliceThickness, std::to_string(thickness).c_str()));
        succeed(measures.putAndInsertString(DCM_PixelSpacing, "1\\1"));
      });
      put_pixels(d, pixels_of(3));
    };
    write(image, folder / "enhanced");
    EXPECT_EQ(only_series_in(folder).details.thickness_mm, expected) << of_file << " " << of_first;
  }
}

}  // namespace
}  // namespace palpate::io::internal
