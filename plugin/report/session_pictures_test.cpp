/// A session's pictures: each chart's numbers against a session with chosen numbers, and a slice's pixels against the
/// scan.

#include "plugin/report/session_pictures.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <memory>

#include "modes/testing/test_rig.h"
#include "plugin/report/slice_picture.h"
#include "plugin/testing/test_files.h"

namespace palpate::plugin {
namespace {

modes::Scene pictured_scene() {
  modes::Mode skin = modes::testing::surface(modes::TransferFunction(1.0));
  skin.name = "skin";
  modes::Mode bone = modes::testing::surface(modes::TransferFunction(2.0));
  bone.name = "bone";
  return modes::testing::scene_of({skin, bone});
}

/// A reach that is turned, moved and scaled: the hand's x is the patient's y, its y is z, its z is x.
modes::Plan pictured_plan() {
  modes::Workspace workspace;
  workspace.center_mm = {10, -20, 30};
  workspace.rotation = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
  workspace.mm_per_m = 2000;
  return modes::make_plan(pictured_scene(), io::FieldSet::value | io::FieldSet::gradient, workspace);
}

/// Along the hand's -x for 20 ticks and back for 10, pushed back along +x with 0.1 N more each tick.
Recording pictured() {
  Recording recording;
  for (int n = 0; n < 30; ++n) {
    TickRecord tick;
    tick.index = static_cast<std::uint64_t>(n);
    tick.time_s = 2 + 1e-3 * n;
    tick.probe_m[0] = -1e-3 * (n < 20 ? n : 39 - n);
    tick.proxy_m[0] = tick.probe_m[0] + 5e-4;
    tick.force_n[0] = 77;
    tick.sent_n[0] = 0.1 * n;
    tick.value = 100 + n;
    tick.share_count = n % 2 == 0 ? 2 : 3;
    tick.stage_ns[2] = 700;
    tick.stage_ns[5] = n < 25 ? 500 : 119'000;
    recording.shares.push_back({.tick = tick.index, .mode = 0, .force_n = {0.3, 0, 0}});
    recording.shares.push_back({.tick = tick.index, .mode = 1, .force_n = {0, 0.01 * n, 0}});
    // Of a scene that is being left, or a second one of the skin.
    if (n % 2 == 1) recording.shares.push_back({.tick = tick.index, .mode = n < 15 ? 9U : 0U, .force_n = {0, 0, 0.4}});
    recording.ticks.push_back(tick);
  }
  return recording;
}

TEST(SessionPictures, ForceAndValueAreDrawnOverTheDepthOfTheProbe) {
  const Recording recording = pictured();
  Summary summary;
  // The hand presses along the patient's -y, from 3 mm behind the place of the first tick.
  summary.holds = {{.mode = 1, .contact_mm = {10, -23, 30}, .value = 250.4},
                   {.mode = 1, .contact_mm = {10, -31, 30}, .value = 1},
                   {.mode = 0, .contact_mm = {10, -33, 30}, .value = 40}};
  const auto charts = force_depth_charts(recording, summary, pictured_scene(), pictured_plan(), "HU");
  EXPECT_EQ(charts[0].x.label, "depth of the probe (mm)");
  EXPECT_EQ(charts[0].y.label, "force (N)");
  EXPECT_EQ(charts[1].y.label, "value (HU)");
  ASSERT_EQ(charts[0].curves.size(), 2U);
  const Curve &in = charts[0].curves[0], &out = charts[0].curves[1], &value = charts[1].curves[0];
  EXPECT_EQ(in.label, "force, going in");
  EXPECT_EQ(out.label, "force, coming out");
  ASSERT_EQ(in.x.size(), 20U);
  ASSERT_EQ(out.x.size(), 10U);
  ASSERT_EQ(value.x.size(), 30U);
  for (std::size_t n = 0; n < 30; ++n) {
    const auto tick = static_cast<double>(n);
    const double depth = 2 * (n < 20 ? tick : 39 - tick) - 3;
    const Curve& curve = n < 20 ? in : out;
    EXPECT_NEAR(curve.x[n < 20 ? n : n - 20], depth, 1e-9) << n;
    EXPECT_NEAR(curve.y[n < 20 ? n : n - 20], 0.1 * tick, 1e-12) << n;
    EXPECT_NEAR(value.x[n], depth, 1e-9);
    EXPECT_EQ(value.y[n], 100 + tick);
  }
  for (const Chart& chart : charts) {
    ASSERT_EQ(chart.marks.size(), 2U) << "each boundary once, where it was met first";
    EXPECT_NEAR(chart.marks[0].at, 0, 1e-9);
    EXPECT_EQ(chart.marks[0].label, "bone: 250 HU");
    EXPECT_NEAR(chart.marks[1].at, 10, 1e-9);
    EXPECT_EQ(chart.marks[1].label, "skin: 40 HU");
  }
}

TEST(SessionPictures, EachModesForceIsDrawnOverTime) {
  const Chart chart = force_time_chart(pictured(), pictured_scene());
  ASSERT_EQ(chart.curves.size(), 3U);
  EXPECT_EQ(chart.curves[0].label, "sent to the device");
  EXPECT_EQ(chart.curves[1].label, "skin");
  EXPECT_EQ(chart.curves[2].label, "bone");
  for (std::size_t n = 0; n < 30; ++n) {
    const auto tick = static_cast<double>(n);
    for (const Curve& curve : chart.curves) EXPECT_EQ(curve.x[n], 2 + 1e-3 * tick);
    EXPECT_NEAR(chart.curves[0].y[n], 0.1 * tick, 1e-12);
    EXPECT_NEAR(chart.curves[1].y[n], n >= 15 && n % 2 == 1 ? 0.5 : 0.3, 1e-12) << n;
    EXPECT_NEAR(chart.curves[2].y[n], 0.01 * tick, 1e-12);
  }
}

/// Shares follow one another tick by tick. One of a mode that the scene does not have, the first of them included, is
/// of none of its modes.
TEST(SessionPictures, AShareIsOfItsTickAndOfItsMode) {
  Recording recording;
  for (int n = 0; n < 40; ++n) {
    TickRecord tick;
    tick.index = static_cast<std::uint64_t>(n);
    tick.share_count = n % 3 == 2 ? 2 : 1;
    recording.shares.push_back({.tick = tick.index, .mode = n % 2 == 0 ? 0U : 1U, .force_n = {0, 0, 1.0 + n}});
    const auto beyond = static_cast<std::uint32_t>(2 + n / 3 % 4);
    if (n % 3 == 2) recording.shares.push_back({.tick = tick.index, .mode = beyond, .force_n = {3, 5, 7}});
    recording.ticks.push_back(tick);
  }
  const Chart chart = force_time_chart(recording, pictured_scene());
  ASSERT_EQ(chart.curves.size(), 3U);
  for (std::size_t n = 0; n < 40; ++n) {
    const double own = 1.0 + static_cast<double>(n);
    EXPECT_EQ(chart.curves[1].y.at(n), n % 2 == 0 ? own : 0) << n;
    EXPECT_EQ(chart.curves[2].y.at(n), n % 2 == 1 ? own : 0) << n;
  }
}

/// On the chart's axis all bins are equally wide, and the axis is as long as they are.
TEST(SessionPictures, BinsOfTheTimeOfATickFillALogarithmicAxis) {
  const Chart chart = tick_time_chart(pictured(), {});
  EXPECT_TRUE(chart.x.logarithmic);
  EXPECT_TRUE(chart.y.logarithmic) << "one slow tick among many is seen";
  EXPECT_NEAR(chart.x.minimum.value(), chart.curves.at(0).x.front(), 1e-9);
  EXPECT_NEAR(chart.x.maximum.value(), chart.curves.at(0).x.back(), 1e-6);
  EXPECT_GT(chart.y.minimum.value(), 0);
  EXPECT_LT(chart.y.minimum.value(), 1);
}

/// 25 ticks of 1.2 us and five of 119.7: each in the bin that it lies in, twenty of them a decade.
TEST(SessionPictures, ATicksTimeIsCountedInItsBin) {
  Summary summary;
  summary.tick_us = {.median = 1.25, .p99 = 8, .p999 = 123.456, .largest = 200};
  const Chart chart = tick_time_chart(pictured(), summary);
  const Curve& counts = chart.curves.at(0);
  double all = 0;
  for (std::size_t bin = 0; bin + 1 < counts.x.size(); ++bin) {
    const auto in_bin = [&](double us) { return us >= counts.x[bin] && us < counts.x[bin + 1]; };
    EXPECT_NEAR(counts.x[bin + 1] / counts.x[bin], std::pow(10, 0.05), 1e-9);
    EXPECT_EQ(counts.y[bin], in_bin(1.2) ? 25 : in_bin(119.7) ? 5 : 0) << counts.x[bin];
    all += counts.y[bin];
  }
  EXPECT_EQ(all, 30);
  EXPECT_EQ(counts.style, Curve::Style::bars);
  EXPECT_NEAR(counts.x.front(), 0.1, 1e-12);
  ASSERT_EQ(chart.marks.size(), 3U);
  EXPECT_EQ(chart.marks[0].at, 1.25);
  EXPECT_EQ(chart.marks[0].label, "median 1.25 us");
  EXPECT_EQ(chart.marks[1].at, 123.456);
  EXPECT_EQ(chart.marks[1].label, "99.9 % 123.46 us");
  EXPECT_EQ(chart.marks[2].at, 1000);
}

/// Where there is no time at all and where there is too much of it.
TEST(SessionPictures, TimesBeyondTheChartAreInItsOutermostBins) {
  Recording recording;
  recording.ticks.resize(3);
  recording.ticks[1].stage_ns[0] = 4'000'000'000;
  recording.ticks[2].stage_ns[0] = 9'990'000;
  const Curve counts = tick_time_chart(recording, {}).curves.at(0);
  EXPECT_EQ(counts.y.front(), 1);
  EXPECT_EQ(counts.y.at(99), 2);
}

/// Value tells the place.
class Rising final : public io::FieldSource {
 public:
  io::FieldSet available() const noexcept override { return io::FieldSet::value; }
  io::Sample sample(const io::Vec3& at, io::FieldSet) const noexcept override {
    io::Sample sample;
    sample.inside = at.x < 40;
    sample.value = 5 * at.x + 3 * at.y - 2 * at.z;
    return sample;
  }
};

/// The plane that the path leaves least, as radiologists hang it (DICOM's patient space): axial from the feet, the left
/// side on the right and the back below; coronal from the front, the left on the right; sagittal from the left, the
/// back on the right; head up in both.
TEST(SessionPictures, ASliceIsThePlaneOfThePathAsRadiologistsHangIt) {
  struct Wanted {
    int thin;  // device axis that the path does not leave
    glm::dvec3 right, down;
  };
  // The hand's axes are the patient's y, z and x.
  for (const Wanted& wanted :
       {Wanted{1, {1, 0, 0}, {0, 1, 0}}, Wanted{0, {1, 0, 0}, {0, 0, -1}}, Wanted{2, {0, 1, 0}, {0, 0, -1}}}) {
    Recording recording;
    recording.ticks.resize(2);
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == wanted.thin) continue;
      recording.ticks[0].probe_m[axis] = -0.004;
      recording.ticks[1].probe_m[axis] = 0.020 + 0.001 * axis;
    }
    const SliceView view = slice_view(recording, pictured_plan(), "HU", Rising());
    EXPECT_EQ(view.right, wanted.right);
    EXPECT_EQ(view.down, wanted.down);
    EXPECT_EQ(view.window_level, 100);
    EXPECT_EQ(view.window_width, 1400);
    glm::dvec3 middle_m(0);
    double longest_mm = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (axis == wanted.thin) continue;
      middle_m[axis] = 0.5 * (0.020 + 0.001 * axis - 0.004);
      longest_mm = std::max(longest_mm, 2000 * (0.024 + 0.001 * axis));
    }
    EXPECT_LT(glm::distance(view.center_mm, pictured_plan().workspace.to_patient(middle_m)), 1e-9);
    EXPECT_NEAR(view.extent_mm, 2.2 * longest_mm, 1e-9);
  }
}

/// Without an absolute scale black is the least and white the most of what is shown.
TEST(SessionPictures, ASlicesWindowIsWhatLiesAroundThePath) {
  Recording recording;
  recording.ticks.resize(2);
  recording.ticks[1].probe_m[0] = 0.001;
  recording.ticks[1].probe_m[2] = 0.0011;
  const SliceView view = slice_view(recording, pictured_plan(), "", Rising());
  EXPECT_EQ(view.extent_mm, 60) << "at least";
  double low = 1e9, high = -1e9;
  for (const double u : {-30.0, 30.0}) {
    for (const double v : {-30.0, 30.0}) {
      const glm::dvec3 at = view.center_mm + std::min(u, 39.5 - view.center_mm.x) * view.right + v * view.down;
      const double value = Rising().sample(at, io::FieldSet::value).value;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  EXPECT_NEAR(view.window_level, 0.5 * (low + high), 3);
  EXPECT_NEAR(view.window_width, high - low, 6);
}

/// An arrow stands at the proxy, as long as the force is strong, a millimeter of the probe's way after the last.
TEST(SessionPictures, AnArrowIsTheForceAtTheProxy) {
  Recording recording;
  for (int n = 0; n < 400; ++n) {
    TickRecord tick;
    tick.probe_m[0] = 4e-6 * n;  // 0.008 mm of patient
    tick.proxy_m[0] = tick.probe_m[0] + 1e-3;
    tick.sent_n[0] = n < 100 ? 0.04 : 0.5;
    tick.sent_n[1] = n < 100 ? 0 : -1;
    recording.ticks.push_back(tick);
  }
  const std::vector<ForceArrow> arrows = force_arrows(recording, pictured_plan());
  ASSERT_EQ(arrows.size(), 3U);
  double before_mm = -1e9;
  for (const ForceArrow& arrow : arrows) {
    EXPECT_LT(glm::distance(arrow.force_n, glm::dvec3(0, 0.5, -1)), 1e-12);
    EXPECT_NEAR(arrow.at_mm.x, 10, 1e-9);
    EXPECT_NEAR(arrow.at_mm.z, 30, 1e-9);
    const double way_mm = arrow.at_mm.y - 2 + 20;  // of the probe
    EXPECT_GE(way_mm, 0.8 - 1e-9);
    if (before_mm > -1e8) {
      EXPECT_NEAR(way_mm - before_mm, 1.04, 0.05);
    }
    before_mm = way_mm;
  }
}

/// A picture's legend names the probe first: along the probe's way is the color of that line, and along the proxy's way
/// the color of the second.
TEST(SessionPictures, ASliceShowsProbeAndProxyWhereEachWas) {
  using Rgb = std::array<int, 3>;
  const auto folder = testing::fresh_path("slice");
  std::filesystem::create_directories(folder);
  const Summary summary{.tick_us = {.median = 1, .p99 = 2, .p999 = 3, .largest = 4}};
  for (const double aside_m : {-0.005, 0.004}) {
    Recording recording;
    for (int n = 0; n <= 20; ++n) {
      TickRecord tick;
      tick.time_s = 1e-3 * n;
      tick.probe_m[0] = tick.proxy_m[0] = 1e-3 * (n - 10);  // 20 mm to both sides of the middle, downwards
      tick.proxy_m[2] = aside_m;                            // to the patient's left
      recording.ticks.push_back(tick);
    }
    write_session_pictures(recording, summary, pictured_scene(), pictured_plan(), Rising(), "HU", folder);
    const std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)> image(
        cairo_image_surface_create_from_png((folder / "slice.png").c_str()), cairo_surface_destroy);
    ASSERT_EQ(cairo_image_surface_get_width(image.get()), 960);
    ASSERT_EQ(cairo_image_surface_get_height(image.get()), 760);
    const auto at = [&](double x, double y) {
      const unsigned char* const bgr = cairo_image_surface_get_data(image.get()) +
                                       static_cast<int>(y) * cairo_image_surface_get_stride(image.get()) +
                                       4 * static_cast<int>(x);
      return Rgb{bgr[2], bgr[1], bgr[0]};
    };
    const Rgb probe = at(27, 53), proxy = at(27, 73);
    ASSERT_NE(probe, proxy);
    constexpr double pixels_per_mm = 960 / 88.0, middle_y = 34 + (760 - 34) / 2.0;
    for (const double along_mm : {-17.0, -9.0, 4.0, 12.0, 18.0}) {
      const double row = middle_y + pixels_per_mm * along_mm;
      EXPECT_EQ(at(480, row), probe) << along_mm;
      EXPECT_EQ(at(480 + pixels_per_mm * 2000 * aside_m, row), proxy) << along_mm;
    }
  }
}

/// Each pixel is the scan's value at its place, from black to white over the window; outside it is black.
TEST(SlicePicture, APixelIsTheValueAtItsPlace) {
  SliceView view;
  view.center_mm = {3, 4, 5};
  view.right = glm::normalize(glm::dvec3(1, 0, -0.5));
  view.down = {0, -1, 0};
  view.extent_mm = 120;
  view.window_level = 20;
  view.window_width = 400;
  constexpr int width = 300, height = 234;  // of which 34 are the title's
  const Canvas canvas = draw_slice(Rising(), view, {}, {}, "", width, height);
  const auto pixels = canvas.pixels();
  int compared = 0;
  for (int row = 70; row < 200; row += 7) {
    for (int column = 40; column < 250; column += 7) {
      if (std::abs(column - 150) < 30 || std::abs(row - 134) < 25) continue;  // letters
      const double mm = 120.0 / width;
      const glm::dvec3 at =
          view.center_mm + mm * (column + 0.5 - 150) * view.right + mm * (row + 0.5 - 134) * view.down;
      const io::Sample sample = Rising().sample(at, io::FieldSet::value);
      const double wanted = sample.inside ? 255 * std::clamp((sample.value - 20) / 400 + 0.5, 0.0, 1.0) : 0;
      ASSERT_NEAR(pixels[4 * static_cast<std::size_t>(row * width + column)], wanted, 2) << row << " " << column;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

/// LPS: x to the left, y to the back (posterior), z to the head; the letter that it leans to most comes first.
TEST(SlicePicture, LettersAreTheSidesOfThePatient) {
  EXPECT_EQ(orientation_letters({1, 0, 0}), "L");
  EXPECT_EQ(orientation_letters({-1, 0, 0}), "R");
  EXPECT_EQ(orientation_letters({0, 1, 0}), "P");
  EXPECT_EQ(orientation_letters({0, -1, 0}), "A");
  EXPECT_EQ(orientation_letters({0, 0, 1}), "H");
  EXPECT_EQ(orientation_letters({0, 0, -1}), "F");
  EXPECT_EQ(orientation_letters({0.5, -0.8, 0.3}), "AL");
  EXPECT_EQ(orientation_letters({0.1, -0.9, 0.4}), "AH");
  EXPECT_EQ(orientation_letters({0.1, -1, 0.2}), "A") << "less than 15 degrees";
  EXPECT_EQ(orientation_letters({0, 0, 0}), "");
}

}  // namespace
}  // namespace palpate::plugin
