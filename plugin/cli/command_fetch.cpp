#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/archive/fetch.h"
#include "plugin/app/archive_settings.h"
#include "plugin/app/errors.h"
#include "plugin/app/fetched.h"
#include "plugin/app/interruptible.h"
#include "plugin/cli/archive_option.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

struct FetchOptions {
  std::string archive;
  std::vector<std::string> uids;
  std::filesystem::path output;
  io::FetchLimits limits;
  std::uint64_t most_mib = io::FetchLimits().bytes >> 20U;
  bool json = false;
};

bool show_fetched(const io::FetchProgress& progress) {
  const std::string of = progress.expected < 0 ? "" : fmt::format(" of {}", progress.expected);
  show_progress(fmt::format("fetching: {}{} images, {} MiB", progress.files, of, progress.bytes >> 20U));
  return !Interruptible::interrupted();
}

void print_fetched(const io::Fetched& fetched, bool json) {
  if (!json) {
    for (const io::FetchedSeries& series : fetched.series) {
      put("{}  {} images  series {}\n", series.folder.string(), series.files, series.uid);
    }
    return;
  }
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const io::FetchedSeries& series : fetched.series) {
    all.push_back({{"series_uid", series.uid},
                   {"study_uid", series.study_uid},
                   {"folder", series.folder.string()},
                   {"images", series.files}});
  }
  const nlohmann::ordered_json whole{{"series", all},
                                     {"images", fetched.files},
                                     {"bytes", fetched.bytes},
                                     {"complete", fetched.complete},
                                     {"warnings", fetched.warnings}};
  put_json(whole, 1);
}

void run(FetchOptions options) {
  const Interruptible interruptible;
  options.limits.bytes = options.most_mib << 20U;
  const std::filesystem::path folder = options.output.empty() ? fetched_folder() : options.output;
  const io::Archive archive = archive_named(options.archive);
  io::Fetched fetched;
  try {
    fetched = io::fetch(archive, options.uids, folder, options.limits, show_fetched);
  } catch (...) {
    show_progress("");
    throw;
  }
  show_progress("");
  print_fetched(fetched, options.json);
  for (const Text& warning : fetched.warnings) tell(at_place("palpate: warning", warning));
  if (options.output.empty()) {
    tell(say("fetched-stays", folder.string()));
  }
  if (!fetched.complete) throw InputRefused(say("not-all-images-came"));
}

}  // namespace

void add_fetch(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("fetch", "Fetches studies and series from an archive into a folder (C-MOVE or C-GET)");
  const auto options = std::make_shared<FetchOptions>();
  add_archive_option(*command, options->archive);
  command->add_option("UID", options->uids, "studies and series, by the UIDs that `palpate find` lists")->required();
  command->add_option("-o,--output", options->output,
                      "folder to fetch into, with a subfolder for each series (default: a private folder, see `palpate "
                      "archive empty`)");
  command->add_option("--most-mib", options->most_mib, "stop after this many MiB")->capture_default_str();
  command->add_option("--most-files", options->limits.files, "give up if there are more files than this")
      ->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
