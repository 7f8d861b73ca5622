// palpate-testdata: phantoms with known answers, a flow and a real head CT, written as DICOM series.

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "testdata/invesalius.h"
#include "testdata/scan.h"
#include "testdata/write_flow.h"
#include "testdata/write_series.h"

namespace {

using namespace palpate;
using testdata::Phantom;
using testdata::Vec3;

struct PhantomRequest {
  std::string kind;
  std::string folder;
  std::vector<double> spacing{1, 1, 1};
  std::vector<int> size{64, 64, 64};
  std::vector<double> orientation{1, 0, 0, 0, 1, 0};
  double radius = 20;
  double wall = 10;
  double tilt = 0;
  double uneven = 0;
  double noise = 0;
  double circle = 0;
  bool untagged = false;
  std::vector<int> missing;
  std::vector<double> window;
  std::uint64_t seed = 1;
};

Phantom make_phantom(const PhantomRequest& request) {
  using namespace testdata;
  if (request.kind == "slab") {
    const Layer layers[] = {{-request.wall, soft_tissue_hu}, {0, bone_hu}, {request.wall, soft_tissue_hu}};
    return make_slab(Vec3(0, 1, 0), layers);
  }
  if (request.kind == "sphere") {
    return make_sphere(request.radius);
  }
  if (request.kind == "shell") {
    return make_shell(request.radius, request.radius + request.wall);
  }
  if (request.kind == "tube") {
    return make_tube(request.radius, Vec3(0, 0, 1));
  }
  if (request.kind == "chest") {
    return make_chest();
  }
  return make_wedge(60);
}

void write_phantom(const PhantomRequest& request) {
  testdata::Grid grid;
  grid.size = {request.size[0], request.size[1], request.size[2]};
  grid.spacing = {request.spacing[0], request.spacing[1], request.spacing[2]};
  grid.direction_i = {request.orientation[0], request.orientation[1], request.orientation[2]};
  grid.direction_j = {request.orientation[3], request.orientation[4], request.orientation[5]};
  grid.tilt_degrees = request.tilt;
  grid.uneven_mm = request.uneven;
  grid.missing = request.missing;
  testdata::Acquisition acquisition;
  acquisition.noise = request.noise;
  acquisition.seed = request.seed;
  acquisition.slice_thickness = request.spacing[2];
  acquisition.circle_radius = request.circle;
  io::Volume volume = testdata::scan(make_phantom(request), testdata::make_geometry(grid), acquisition);
  if (request.untagged) volume.padding.reset();
  testdata::SeriesLabel label{.description = "phantom: " + request.kind};
  if (!request.window.empty()) label.window = {request.window[0], request.window[1]};
  testdata::write_series(volume, request.folder, label);
  std::printf("%s: %d slices of a %s\n", request.folder.c_str(), volume.geometry.dimensions.z, request.kind.c_str());
}

void write_invesalius(const std::string& file, const std::string& folder) {
  const io::Volume volume = testdata::read_invesalius(file);
  testdata::write_series(volume, folder,
                         {"head CT (invesalius-examples)", "INVESALIUS",
                          "From Debian's invesalius-examples (GPL-2). Left and right are assumed.", 1});
  std::printf("%s: %d slices of a head CT; left and right are assumed\n", folder.c_str(), volume.geometry.dimensions.z);
}

void add_phantom(CLI::App& program, PhantomRequest& request) {
  CLI::App& command = *program.add_subcommand("phantom", "Write a phantom with known answers");
  command.add_option("kind", request.kind, "slab, sphere, shell, tube, wedge or chest")
      ->required()
      ->check(CLI::IsMember({"slab", "sphere", "shell", "tube", "wedge", "chest"}));
  command.add_option("-o,--output", request.folder, "Folder to make")->required();
  command.add_option("--spacing", request.spacing, "mm between columns, rows, slices")->delimiter(',')->expected(3);
  command.add_option("--size", request.size, "Columns, rows, slices")->delimiter(',')->expected(3);
  command.add_option("--orientation", request.orientation, "Direction cosines, as ImageOrientationPatient")
      ->delimiter(',')
      ->expected(6);
  command.add_option("--radius", request.radius, "mm: of the sphere, the shell's cavity or the tube")
      ->check(CLI::PositiveNumber);
  command.add_option("--wall", request.wall, "mm: thickness of the shell's wall or the slab's layers")
      ->check(CLI::PositiveNumber);
  command.add_option("--tilt", request.tilt, "Gantry tilt, degrees");
  command.add_option("--uneven", request.uneven, "mm: displace the slices along the step by up to this");
  command.add_option("--missing", request.missing, "Slices to leave out, ascending")->delimiter(',');
  command.add_option("--noise", request.noise, "Standard deviation, HU")->check(CLI::NonNegativeNumber);
  command.add_option("--circle", request.circle, "mm: radius of the reconstruction circle; 0: none")
      ->check(CLI::NonNegativeNumber);
  command.add_flag("--untagged", request.untagged, "Do not say what is padding: no PixelPaddingValue");
  command.add_option("--window", request.window, "Level and width that the series asks for, HU")
      ->delimiter(',')
      ->expected(2);
  command.add_option("--seed", request.seed, "Of the noise");
  command.callback([&request] { write_phantom(request); });
}

struct FlowRequest {
  testdata::FlowStudy study;
  std::string folder;
  std::vector<double> spacing{2.5, 2.5, 2.5};
  std::vector<int> size{48, 48, 48};
  double speed = 1;
};

void write_flow(FlowRequest& request) {
  request.study.flow.free_stream = {request.speed, 0, 0};
  request.study.grid.size = {request.size[0], request.size[1], request.size[2]};
  request.study.grid.spacing = {request.spacing[0], request.spacing[1], request.spacing[2]};
  testdata::write_flow_study(request.study, request.folder);
  std::printf("%s: flow past a sphere of %g mm, %d times\n", request.folder.c_str(), request.study.flow.radius,
              request.study.times);
}

void add_flow(CLI::App& program, FlowRequest& request) {
  CLI::App& command = *program.add_subcommand("flow", "Write a 4D-flow study: flow past a sphere, pulsating");
  command.add_option("-o,--output", request.folder, "Folder to make")->required();
  command.add_option("--spacing", request.spacing, "mm between columns, rows, slices")->delimiter(',')->expected(3);
  command.add_option("--size", request.size, "Columns, rows, slices")->delimiter(',')->expected(3);
  command.add_option("--radius", request.study.flow.radius, "mm: of the sphere")->check(CLI::PositiveNumber);
  command.add_option("--speed", request.speed, "m/s: mean free stream, towards the patient's left")
      ->check(CLI::PositiveNumber);
  command.add_option("--times", request.study.times, "In one cycle")->check(CLI::PositiveNumber);
  command.callback([&request] { write_flow(request); });
}

int run(int argc, char** argv) {
  CLI::App program("Phantoms with known answers, a flow and a real head CT, written as DICOM series",
                   "palpate-testdata");
  program.require_subcommand(1);
  program.option_defaults()->always_capture_default();
  PhantomRequest request;
  add_phantom(program, request);
  FlowRequest flow;
  add_flow(program, flow);

  std::string file = testdata::invesalius_cranium;
  std::string folder;
  CLI::App& command =
      *program.add_subcommand("invesalius", "Rewrite an InVesalius project's head CT as a DICOM series");
  command.add_option("file", file, "The project")->capture_default_str();
  command.add_option("-o,--output", folder, "Folder to make")->required();
  command.callback([&] { write_invesalius(file, folder); });

  constexpr int wrong_usage = 2;
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : wrong_usage;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate-testdata: %s\n", error.what());
    return 1;
  }
}
