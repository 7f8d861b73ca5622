#include "solver/exact/sorted.h"

namespace palpate::solver::internal {

void Sorted::fit(std::size_t n) {
  primitives_.resize(n);
  forces_.resize(n);
  order_.resize(n);
}

std::size_t Sorted::memory_bytes() const noexcept {
  return primitives_.capacity() * sizeof(Primitive) + forces_.capacity() * sizeof(Vec3) +
         order_.capacity() * sizeof(std::uint32_t);
}

Balance Sorted::take(const Balance& balance, std::span<const Vec3> forces) {
  count_ = 0;
  for (const PrimitiveType type :
       {PrimitiveType::directed_force, PrimitiveType::plane, PrimitiveType::line, PrimitiveType::point}) {
    for (std::size_t i = 0; i < balance.primitives.size(); ++i) {
      if (balance.primitives[i].type == type) {
        order_[count_] = static_cast<std::uint32_t>(i);
        primitives_[count_] = balance.primitives[i];
        forces_[count_++] = forces[i];
      }
    }
  }
  return {balance.stiffness, balance.probe, balance.previous_proxy, std::span(primitives_).first(count_)};
}

void Sorted::give_back(std::span<Vec3> forces, Solution& solution) const {
  for (std::size_t i = 0; i < count_; ++i) {
    forces[order_[i]] = forces_[i];
  }
  if (solution.rejection) {  // a refusal of the search names a primitive
    solution.rejection->primitive = order_[solution.rejection->primitive];
  }
}

}  // namespace palpate::solver::internal
