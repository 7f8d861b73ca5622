#pragma once

#include <cstddef>
#include <memory>

namespace palpate::io::internal {

/// An array of floats that starts at a cache line; not initialized.
class Lines {
 public:
  explicit Lines(std::size_t floats) : lines_(std::make_unique_for_overwrite<Line[]>((floats + 15) / 16)) {}
  float* get() const noexcept { return lines_[0].floats; }

 private:
  struct alignas(64) Line {
    float floats[16];
  };
  std::unique_ptr<Line[]> lines_;
};

}  // namespace palpate::io::internal
