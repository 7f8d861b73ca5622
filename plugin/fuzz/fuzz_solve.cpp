// libFuzzer's way into `palpate solve`: the first byte chooses the solver, the rest is a line. Every answer is one line
// of JSON, with the error's words or with numbers.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>

#include "plugin/cli/solve_json.h"

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto solvers = palpate::solver::solver_types();
  if (size == 0) return 0;
  const std::size_t choice = data[0] % (solvers.size() + 1);
  const std::string_view line(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto solved =
      palpate::plugin::solve_line(line, {.solver = choice == solvers.size() ? nullptr : solvers[choice]});
  const auto answer = nlohmann::json::parse(solved.json, nullptr, false);
  if (answer.is_discarded() || solved.json.find('\n') != std::string::npos) std::abort();
  if (solved.solved == answer.contains("error")) std::abort();
  if (solved.solved && !answer.at("proxy").at(0).is_number()) std::abort();
  return 0;
}
