#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/archive/send.h"
#include "plugin/app/archive_settings.h"
#include "plugin/app/errors.h"
#include "plugin/app/interruptible.h"
#include "plugin/cli/archive_option.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

struct SendOptions {
  std::string archive;
  std::vector<std::filesystem::path> files;
  bool json = false;
};

/// Folders stand for the files in them.
std::vector<std::filesystem::path> files_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void run(const SendOptions& options) {
  const Interruptible interruptible;
  const std::vector<std::filesystem::path> files = files_of(options.files);
  const io::Archive archive = archive_named(options.archive);
  const io::Sent sent = io::send(archive, files, [&](std::size_t done) {
    show_progress(fmt::format("sending: {} of {} files", done, files.size()));
    return !Interruptible::interrupted();
  });
  show_progress("");
  if (options.json) {
    const auto listed = [](const std::vector<io::NotSent>& files_and_reasons) {
      nlohmann::ordered_json list = nlohmann::ordered_json::array();
      for (const io::NotSent& one : files_and_reasons) list.push_back({{"file", one.file.string()}, {"why", one.why}});
      return list;
    };
    const nlohmann::ordered_json json{
        {"sent", sent.files}, {"not_sent", listed(sent.not_sent)}, {"warned", listed(sent.warned)}};
    put_json(json, 1);
  } else {
    put("{} files sent to {}\n", sent.files, archive.name);
  }
  for (const io::NotSent& one : sent.warned) tell(at_place("palpate: " + one.file.string(), one.why));
  for (const io::NotSent& one : sent.not_sent) tell(at_place("palpate: " + one.file.string(), one.why));
  if (!sent.not_sent.empty()) throw InputRefused(say("files-not-sent", sent.not_sent.size(), files.size()));
}

}  // namespace

void add_send(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "send", "Sends files to an archive (C-STORE), for example those that `palpate export` has written");
  const auto options = std::make_shared<SendOptions>();
  add_archive_option(*command, options->archive);
  command->add_option("FILE", options->files, "DICOM files, or folders of them")->required()->check(CLI::ExistingPath);
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
