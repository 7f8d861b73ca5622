#include "io/testing/provoked_scans.h"

#include <array>
#include <exception>

#include "io/load.h"
#include "io/series.h"

namespace palpate::io::testing {

namespace fs = std::filesystem;

std::string said_of(const fs::path& folder, const std::function<void()>& between) {
  std::string said;
  const auto catalogue = find_series(std::array{folder});
  between();
  for (const SkippedFile& file : catalogue.skipped) said += file.reason + "\n";
  for (const auto& all : {catalogue.series, catalogue.velocity_fields}) {
    for (const Series& series : all) {
      for (const std::string& warning : series.warnings) said += warning + "\n";
      said += said_when([&] {
        for (const std::string& warning : load(series).warnings) said += warning + "\n";
      });
      said += "\n";
    }
  }
  return said;
}

std::string said_of(const std::function<void(const TestFolder&)>& fill) {
  const TestFolder folder;
  fill(folder);
  return said_of(folder.path());
}

std::string of_bytes(const std::function<std::string(std::string)>& damage) {
  return said_of([&](const TestFolder& folder) {
    internal::write({}, folder / "a.dcm");
    write_bytes(folder / "a.dcm", damage(bytes_of(folder / "a.dcm")));
  });
}

std::string of_image(const std::function<void(DcmDataset&)>& edit) {
  return said_of([&](const TestFolder& folder) {
    TestImage image;
    image.edit = edit;
    internal::write(image, folder / "a.dcm");
  });
}

std::string of_stack(int count, const std::function<void(int, TestImage&)>& change) {
  return said_of([&](const TestFolder& folder) { internal::write_stack(folder.path(), count, change); });
}

}  // namespace palpate::io::testing
