#include "solver/solution.h"

namespace palpate::solver {

const char* name_of(SolverKind kind) {
  switch (kind) {
    case SolverKind::analytical:
      return "analytical";
    case SolverKind::exact:
      return "exact";
    case SolverKind::descent:
      return "descent";
    case SolverKind::none:
      break;
  }
  return "none";
}

}  // namespace palpate::solver
