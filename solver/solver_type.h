#pragma once

/// A solver of force balances, as data and functions. Each solver has two files, <name>.h and <name>.cpp, and one name
/// in solver/CMakeLists.txt, whose order is that of the chain.

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "solver/solution.h"

namespace palpate::solver {

enum class Start : std::uint8_t {
  cold,  ///< the forces given are not read
  warm   ///< from the forces given (N), for example those of the previous tick; any finite numbers are allowed
};

struct RunOptions {
  Start start = Start::cold;
  int max_iterations = 0;  ///< after that many: Outcome::capped; 0: the solver's default
};

/// Memory that a solver keeps from balance to balance: one for each thread.
class Scratch {
 public:
  virtual ~Scratch() = default;
  virtual std::size_t memory_bytes() const noexcept = 0;  ///< on the heap

 protected:
  Scratch() = default;
  Scratch(Scratch&&) noexcept = default;
  Scratch& operator=(Scratch&&) noexcept = default;
};

/// The configurations that a solver can solve.
enum class Solves : std::uint8_t {
  section_3_1,  ///< always those of the paper's section 3.1; it may decline others (Outcome::unsuitable)
  any           ///< configurations of every kind
};

struct SolverType {
  std::string_view name;     ///< as in scenes, summaries and `palpate solve --solver`
  std::uint8_t number = 0;   ///< in recordings: 1 to 63; it never changes
  std::string_view summary;  ///< one line for people
  Solves solves = Solves::any;
  bool is_usual = false;              ///< whether a chain has it by default
  bool reads_forces = false;          ///< whether Start::warm makes a difference
  bool reads_previous_proxy = false;  ///< whether it reads the balance's previous proxy
  /// Memory for balances of up to this number of primitives; a larger balance makes it grow, which allocates. Null if
  /// the solver needs none.
  std::unique_ptr<Scratch> (*make_scratch)(std::size_t primitives) = nullptr;
  /// forces: one for each primitive, N. The balance has to be one that validate() accepts. `scratch` comes from
  /// make_scratch. Does not allocate, lock, throw or log within the scratch's size.
  Solution (*solve)(const Balance& balance, std::span<Vec3> forces, Scratch* scratch,
                    const RunOptions& options) noexcept = nullptr;
};

/// All solvers, in the order of a chain.
std::span<const SolverType* const> solver_types();
/// Null if no solver has that name.
const SolverType* find_solver_type(std::string_view name);
/// The solver with this number in recordings; null if there is none.
const SolverType* solver_of_number(std::uint32_t number) noexcept;
/// The solver's number in recordings; 0 for null.
std::uint32_t number_of(const SolverType* solver) noexcept;
/// The solver's name; "none" for null.
std::string_view name_of(const SolverType* solver) noexcept;

/// A set of solvers.
class SolverSet {
 public:
  SolverSet() = default;
  SolverSet(std::initializer_list<const SolverType*> solvers);
  static SolverSet usual();

  bool contains(const SolverType& solver) const noexcept { return (bits_ & bit_of(solver)) != 0; }
  bool is_empty() const noexcept { return bits_ == 0; }
  void set(const SolverType& solver, bool is_in = true) noexcept;
  /// The same set with one more solver.
  SolverSet with(const SolverType& solver) const noexcept;

 private:
  static std::uint64_t bit_of(const SolverType& solver) noexcept { return std::uint64_t{1} << (solver.number & 63U); }

  std::uint64_t bits_ = 0;
};

}  // namespace palpate::solver
