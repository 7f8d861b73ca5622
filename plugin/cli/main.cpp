// `palpate`: the engine without a screen. A script can do everything that ParaView's panel does.

#include <CLI/CLI.hpp>

#include "plugin/cli/commands.h"
#include "plugin/options/run_program.h"
#include "plugin/options/version.h"

int main(int argc, char** argv) {
  using namespace palpate::plugin;
  CLI::App program{
      "Feel a CT or MR scan: tissue boundaries as forces on a haptic stylus.\n"
      "Research software, not a medical device.\n\n"
      "A first session:  palpate info FOLDER;  palpate probe FOLDER --scene ct-skin-and-bone -o OUT",
      "palpate"};
  program.set_version_flag("--version", version_text());
  add_info(program);
  add_structures(program);
  add_sample(program);
  add_solve(program);
  add_suggest(program);
  add_plan(program);
  add_profile(program);
  add_probe(program);
  add_record(program);
  add_serve(program);
  add_replay(program);
  add_compare(program);
  add_suspects(program);
  add_correct(program);
  add_devices(program);
  add_archive(program);
  add_find(program);
  add_fetch(program);
  add_send(program);
  add_marks(program);
  add_export(program);
  return run_program(program, argc, argv);
}
