// libFuzzer's way into scenes: the bytes are a scene's JSON. What is read is planned, and written out it reads as the
// same scene.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "modes/scene/scene.h"
#include "modes/scene/scene_json.h"

namespace {

using namespace palpate::modes;

Scene read_again(const std::string& written) {
  try {
    return scene_from_json(written, "written");
  } catch (const std::exception&) {
    std::abort();  // what we write, we read
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Scene scene;
  try {
    scene = scene_from_json({reinterpret_cast<const char*>(data), size}, "fuzzed");
  } catch (const std::invalid_argument&) {
    return 0;
  }
  const std::string written = to_json(scene);
  if (to_json(read_again(written)) != written) std::abort();
  return 0;
}
