#include "solver/solver_type.h"

#include <algorithm>
#include <array>

namespace palpate::solver {

// The list of solvers comes from solver/CMakeLists.txt: SOLVER(analytical) SOLVER(exact) ...
#define SOLVER(name) extern const SolverType name##_solver;
PALPATE_SOLVERS
#undef SOLVER

std::span<const SolverType* const> solver_types() {
#define SOLVER(name) &name##_solver,
  static constexpr std::array types{PALPATE_SOLVERS};
#undef SOLVER
  return types;
}

namespace {

template <typename Condition>
const SolverType* find_solver(const Condition& condition) {
  const auto types = solver_types();
  const auto found = std::find_if(types.begin(), types.end(), condition);
  return found == types.end() ? nullptr : *found;
}

}  // namespace

const SolverType* find_solver_type(std::string_view name) {
  return find_solver([name](const SolverType* type) { return type->name == name; });
}

const SolverType* solver_of_number(std::uint32_t number) noexcept {
  return find_solver([number](const SolverType* type) { return type->number == number; });
}

std::uint32_t number_of(const SolverType* solver) noexcept {
  return solver == nullptr ? 0 : solver->number;
}

std::string_view name_of(const SolverType* solver) noexcept {
  return solver == nullptr ? "none" : solver->name;
}

SolverSet::SolverSet(std::initializer_list<const SolverType*> solvers) {
  for (const SolverType* solver : solvers) {
    set(*solver);
  }
}

SolverSet SolverSet::usual() {
  SolverSet solvers;
  for (const SolverType* type : solver_types()) {
    solvers.set(*type, type->is_usual);
  }
  return solvers;
}

void SolverSet::set(const SolverType& solver, bool is_in) noexcept {
  bits_ = is_in ? bits_ | bit_of(solver) : bits_ & ~bit_of(solver);
}

SolverSet SolverSet::with(const SolverType& solver) const noexcept {
  SolverSet more = *this;
  more.set(solver);
  return more;
}

}  // namespace palpate::solver
