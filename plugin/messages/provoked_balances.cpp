#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plugin/cli/solve_json.h"
#include "plugin/messages/provoked.h"
#include "solver/analytical.h"

namespace palpate::plugin::testing {
namespace {

std::string error_of(const std::string& line, const solver::SolverType* solver = nullptr) {
  return nlohmann::json::parse(solve_line(line, {.solver = solver}).json).value("error", "solved");
}

std::string balance(const std::string& primitives, const std::string& more = "") {
  return R"({"id":1,"stiffness":400,"probe":[0,0,-0.001])" + more + R"(,"primitives":)" + primitives + "}";
}

const std::string plane = R"([{"type":"plane","strength":2,"position":[0,0,0],"direction":[0,0,1]}])";

}  // namespace

std::vector<Provoked> provoke_balances() {
  return {
      {"not-json", error_of("hello")},
      {"nested-more-than-deep", error_of(std::string(100, '['))},
      {"given-twice", error_of(R"({"id":1,"id":2})")},
      {"longer-than-bytes", error_of(std::string(20'000'000, ' '))},
      {"line-is-empty", error_of("  ")},
      {"not-a-json-object-but-of-type", error_of("[]")},
      {"not-an-object", error_of(balance("[3]"))},
      {"is-missing", error_of("{}")},
      {"not-a-number", error_of(R"({"stiffness":"a"})")},
      {"not-an-array-of-three-numbers", error_of(R"({"stiffness":400,"probe":[1,2]})")},
      {"strength-is-neither-a-number-nor-inf", error_of(balance(R"([{"type":"plane","strength":"much"}])"))},
      {"type-is-not-a-string", error_of(balance(R"([{"type":3}])"))},
      {"type-is-unknown", error_of(balance(R"([{"type":"wall"}])"))},
      {"id-is-neither-a-string-nor", error_of(R"({"id":[1]})")},
      {"primitives-is-not-an-array", error_of(balance("3"))},
      {"solver-does-not-fit-this-configuration",
       error_of(balance(R"([{"type":"plane","strength":2,"position":[0,0,0],"direction":[0.1,0,1]},)"
                        R"({"type":"line","strength":0.2,"position":[0,0,0],"direction":[1,2,3]}])"),
                &solver::analytical_solver)},
  };
}

}  // namespace palpate::plugin::testing
