#pragma once

/// Shared by the programs: parsing of arguments, and exit codes for errors.

namespace CLI {
class App;
}

namespace palpate::plugin {

/// Runs the requested subcommand. Returns 0 success, 1 refused input, 2 wrong usage, 3 internal fault; errors are
/// printed on stderr. Never throws.
int run_program(CLI::App& program, int argc, char** argv);

}  // namespace palpate::plugin
