#include "plugin/options/run_program.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <sstream>
#include <stdexcept>

#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "solver/text/printable.h"

namespace palpate::plugin {
namespace {

/// Whether all that was printed on stdout has gone out.
bool is_written() {
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

void check_output() {
  if (!is_written()) throw InputRefused(say("standard-output-cannot-be-written"));
}

}  // namespace

int run_program(CLI::App& program, int argc, char** argv) {
  const auto told = [&](const std::exception& error, int exit) {
    std::fprintf(stderr, "%s: %s\n", program.get_name().c_str(), printable(error.what()).c_str());
    return exit;
  };
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::help);
  program.footer("Exit: 0 done, 1 something in the input was refused, 2 wrong usage, 3 internal fault.");
  try {
    program.parse(argc, argv);
    check_output();
    return 0;
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int code = program.exit(error, out, err);  // it names what was typed
    std::fputs(printable(out.str()).c_str(), stdout);
    std::fputs(printable(err.str()).c_str(), stderr);
    if (code != 0) return 2;
    return is_written() ? 0 : told(InputRefused(say("standard-output-cannot-be-written")), 1);
  } catch (const WrongUsage& error) {
    return told(error, 2);
  } catch (const std::runtime_error& error) {  // InputRefused, and what the folders throw of files, series and devices
    return told(error, 1);
  } catch (const std::invalid_argument& error) {  // scenes
    return told(error, 1);
  } catch (const std::exception& error) {
    tell(say("internal-fault", program.get_name(), error.what()));
    tell(say("please-report-it-with-the-command"));
    return 3;
  }
}

}  // namespace palpate::plugin
