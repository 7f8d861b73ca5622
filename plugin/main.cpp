// `palpate`: the engine without a screen. What ParaView's panel does, a script can do.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include "palpate/plugin/command.h"

int main(int argc, char** argv) {
  using namespace palpate::plugin;
  CLI::App program{
      "Feel a CT or MR scan: tissue boundaries as forces on a haptic stylus.\n"
      "Research software, not a medical device.\n\n"
      "A first session:  palpate info FOLDER;  palpate probe FOLDER --scene ct-skin-and-bone -o OUT",
      "palpate"};
  program.set_version_flag("--version", PALPATE_VERSION);
  program.require_subcommand(1);
  program.failure_message(CLI::FailureMessage::help);
  program.footer("Exit: 0 done, 1 something in the input was refused, 2 wrong usage, 3 internal fault.");
  try {
    add_info(program);
    add_sample(program);
    add_solve(program);
    add_suggest(program);
    add_plan(program);
    add_profile(program);
    add_probe(program);
    add_record(program);
    add_replay(program);
    add_compare(program);
    add_devices(program);
    add_bench(program);
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  } catch (const WrongUsage& error) {
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return 2;
  } catch (const std::runtime_error& error) {  // InputRefused, and what the folders throw of files, series and devices
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return 1;
  } catch (const std::invalid_argument& error) {  // scenes
    std::fprintf(stderr, "palpate: %s\n", error.what());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate: internal fault: %s\nPlease report it with the command that caused it.\n",
                 error.what());
    return 3;
  }
}
