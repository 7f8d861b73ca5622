#include "solver/exact/scratch.h"

namespace palpate::solver {

ExactScratch::ExactScratch(std::size_t capacity) : arrays_(std::make_unique<Arrays>()) {
  arrays_->fit(capacity);
}
ExactScratch::~ExactScratch() = default;
std::size_t ExactScratch::memory_bytes() const noexcept {
  const auto size = [](const auto& array) { return array.capacity() * sizeof array[0]; };
  return sizeof(Arrays) + size(arrays_->placed) + size(arrays_->moved) + size(arrays_->forces) + size(arrays_->hold) +
         size(arrays_->met) + arrays_->sorted.memory_bytes() + arrays_->columns.memory_bytes();
}
ExactScratch::ExactScratch(ExactScratch&&) noexcept = default;
ExactScratch& ExactScratch::operator=(ExactScratch&&) noexcept = default;

}  // namespace palpate::solver
