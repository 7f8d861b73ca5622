#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <string>

#include "plugin/app/errors.h"
#include "plugin/app/interruptible.h"
#include "plugin/app/live_session.h"
#include "plugin/app/open_scan.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/ready_session.h"
#include "plugin/cli/session_option.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/openigtlink/say.h"
#include "plugin/openigtlink/serve.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin {
namespace {

struct ServeCommand {
  SessionOption session;
  igtl::Address address;
  std::filesystem::path output;
};

igtl::LoadedScan load_folder(const std::string& folder, const io::Progress& progress) {
  const std::array paths{std::filesystem::path(folder)};
  const io::Series series = choose_series({.path = folder}, io::find_series(paths, progress));
  return {.volume = std::make_shared<const io::Volume>(open_scan(series, 0, progress)),
          .frame = {.number = 0, .count = series.frames_per_position}};
}

void run(const ServeCommand& command) {
  if (!command.output.empty() && std::filesystem::exists(command.output)) {
    throw InputRefused(say("exists-name-another-file", command.output.string()));
  }
  const std::shared_ptr<device::Stylus> stylus = make_stylus(command.session.stylus);
  // The port first: loading takes longer, and would be for nothing.
  igtl::Server server(command.address);
  if (!server.is_local()) tell(igtl::say("igtl-others-may-connect", command.address.host));
  const ReadySession ready = prepare_session(command.session, stylus);
  if (!ready.simulated) stylus->close();  // the session opens it
  const Interruptible interruptible;      // until the file is whole
  LiveSession session;
  session.set_scan(ready.volume, ready.run.scene, ready.run.frame);
  if (command.output.empty()) {
    session.connect(stylus);
  } else {  // a recording begins a session anew: without a force before it
    session.connect(stylus, LiveSession::Start::released);
    session.record(command.output);
    session.feel();
  }
  tell(igtl::say("igtl-listens", command.address.host, server.port()));
  igtl::serve(session, server,
              {.seconds = command.session.seconds,
               .load = load_folder,
               .keep_maps_in = command.output.empty() ? command.output : structures_beside(command.output)});
  const auto recorded = session.disconnect();
  if (recorded && recorded->stopped) throw InputRefused(recorded->why);
}

}  // namespace

void add_serve(CLI::App& program) {
  auto options = std::make_shared<ServeCommand>();
  CLI::App* command = program.add_subcommand(
      "serve",
      "Feels a scan and shares it with 3D Slicer or another client of OpenIGTLink, until Ctrl-C.\n"
      "Stylus, proxy and force go out sixty times a second; scenes, marks and label maps come in.\n"
      "No client can turn the force on or raise a limit. The first client that sends something may set scenes, marks "
      "and "
      "label maps; the others can only read.");
  add_session_option(*command, options->session);
  command->add_option("--port", options->address.port, "where to listen; 0: any port that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      ->add_option("--host", options->address.host,
                   "the address of this machine to listen on; any but 127.0.0.1 lets other machines read the session "
                   "and set scenes")
      ->capture_default_str();
  command->add_option(
      "-o,--output", options->output,
      "record the session to this file (HDF5); it must be new. Label maps that are felt are kept beside it, in the "
      "folder FILE.structures");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
