#pragma once

/// What the programs share: parsing their arguments, and an exit code for what goes wrong.

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Runs the subcommand that was asked for. Returns 0 done, 1 something in the input was refused, 2 wrong usage,
/// 3 internal fault, after saying it on stderr. Never throws.
int run_program(CLI::App& program, int argc, char** argv);

}  // namespace palpate::plugin
