
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/solve_json.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

/// The next line without its end; of a line that is too long, only enough to detect that. False at the end of input.
bool read_line(std::FILE* input, std::string& line) {
  line.clear();
  int c = std::getc(input);
  if (c == EOF) return false;
  for (; c != EOF && c != '\n'; c = std::getc(input)) {
    if (line.size() <= longest_line) line.push_back(static_cast<char>(c));
  }
  return true;
}

void run(const SolveOptions& options) {
  std::size_t lines = 0;
  std::size_t refused = 0;
  std::string line;
  while (read_line(stdin, line)) {
    SolvedLine answer = solve_line(line, options);
    ++lines;
    refused += answer.solved ? 0 : 1;
    answer.json.push_back('\n');
    // Flushed, so that a program at the other end of the pipe may wait for each answer.
    if (std::fwrite(answer.json.data(), 1, answer.json.size(), stdout) != answer.json.size() ||
        std::fflush(stdout) != 0) {
      throw InputRefused(say("standard-output-cannot-be-written"));
    }
  }
  if (std::ferror(stdin) != 0) throw InputRefused(say("standard-input-cannot-be-read"));
  if (refused > 0) {
    throw InputRefused(say("lines-not-solved", refused, lines, lines == 1 ? "" : "s"));
  }
}

}  // namespace

void add_solve(CLI::App& program) {
  std::map<std::string, std::uint32_t> numbers{{"chain", 0}};
  std::string names = "chain (default)";
  for (const solver::SolverType* const type : solver::solver_types()) {
    numbers[std::string(type->name)] = type->number;
    names += (type == solver::solver_types().back() ? " or " : ", ") + std::string(type->name);
  }
  CLI::App* command =
      program.add_subcommand("solve", "Solves force balances: JSON Lines on stdin, answers as JSON Lines on stdout");
  const auto options = std::make_shared<SolveOptions>();
  command
      ->add_option_function<std::uint32_t>(
          "--solver", [options](std::uint32_t number) { options->solver = solver::solver_of_number(number); }, names)
      ->transform(CLI::CheckedTransformer(numbers))
      ->option_text("NAME");
  command->add_option("--repeat", options->repeat, "How often each balance is solved; time_ns is the fastest")
      ->check(CLI::Range(1, 1000000000))
      ->option_text("N");
  command->footer(
      "In:  {\"id\":1,\"stiffness\":400,\"probe\":[0,0,-0.002],\"primitives\":[{\"type\":\"plane\",\"strength\":2,\n"
      "      \"position\":[0,0,0],\"direction\":[0,0,1]}]}     meters, newtons; a strength may be \"inf\"\n"
      "Out: {\"id\",\"proxy\",\"force\",\"forces\",\"solver\",\"error_bound\",\"iterations\",\"time_ns\"} or "
      "{\"id\",\"error\"}\n"
      "Every line is answered. The exit status is 1 if any answer is an error.");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
