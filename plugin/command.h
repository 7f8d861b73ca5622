#pragma once

/// The subcommands of `palpate`, one file each. Exit codes: 0 done, 1 something in the input was refused, 2 wrong
/// usage, 3 internal fault.

#include <stdexcept>

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Something in the input was refused: exit 1. The message names the file, series, primitive or device and what to do.
class InputRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The command was called wrongly: exit 2.
class WrongUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Each adds its subcommand to the program; the subcommand's callback does the work, prints to stdout and throws the
// above.
void add_info(CLI::App& program);
void add_sample(CLI::App& program);
void add_suggest(CLI::App& program);
void add_plan(CLI::App& program);
void add_profile(CLI::App& program);
void add_probe(CLI::App& program);
void add_record(CLI::App& program);
void add_replay(CLI::App& program);
void add_compare(CLI::App& program);
void add_solve(CLI::App& program);
void add_devices(CLI::App& program);
void add_bench(CLI::App& program);

}  // namespace palpate::plugin
