#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "io/archive/archive.h"
#include "plugin/app/archive_json.h"
#include "plugin/app/archive_settings.h"
#include "plugin/app/errors.h"
#include "plugin/app/fetched.h"
#include "plugin/cli/commands.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

struct ArchiveOptions {
  io::Archive archive;
  bool json = false;
};

std::string one_line(const io::Archive& archive) {
  return fmt::format(
      "{}  {}:{}  its AE title {}, ours {}; {}{}", archive.name, archive.host, archive.port, archive.called,
      archive.calling,
      archive.uses_get ? "C-GET" : fmt::format("C-MOVE to {}:{}", archive.listen_address, archive.listen_port),
      archive.tls.used ? "; TLS" : "");
}

void add_to_settings(const ArchiveOptions& options) {
  io::Archive archive = options.archive;
  archive.tls.used = !archive.tls.authorities.empty() || !archive.tls.certificate.empty() || !archive.tls.key.empty();
  for (auto* file : {&archive.tls.authorities, &archive.tls.certificate, &archive.tls.key}) {
    if (!file->empty()) *file = std::filesystem::absolute(*file);
  }
  io::check(archive);
  std::vector<io::Archive> all = read_archives();
  std::erase_if(all, [&](const io::Archive& other) { return other.name == archive.name; });
  all.push_back(archive);
  write_archives(all);
  put("{}\n", one_line(archive));
  if (!archive.uses_get) {
    put("The archive has to know AE title {} at this machine's address, port {}, as a place to send to. Try `palpate "
        "archive echo {}`.\n",
        archive.calling, archive.listen_port, archive.name);
  }
}

void list_archives(const ArchiveOptions& options) {
  const std::vector<io::Archive> all = read_archives();
  const OnDisk there = fetched_on_disk();
  if (!options.json) {
    for (const io::Archive& archive : all) put("{}\n", one_line(archive));
    put("{} series fetched and not deleted yet, {} MiB, in {}\n", there.series, there.bytes >> 20U,
        fetched_folder().string());
    return;
  }
  nlohmann::ordered_json json{{"archives", nlohmann::ordered_json::array()}};
  for (const io::Archive& archive : all) {
    nlohmann::ordered_json entry = connection_json(archive);
    entry["tls"] = archive.tls.used;
    json["archives"].push_back(std::move(entry));
  }
  json["fetched"] = {{"folder", fetched_folder().string()}, {"series", there.series}, {"bytes", there.bytes}};
  put_json(json, 1);
}

void echo_archive(const ArchiveOptions& options) {
  const io::Archive archive = archive_named(options.archive.name);
  const auto begin = std::chrono::steady_clock::now();
  io::echo(archive);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  if (options.json) {
    put_json(nlohmann::ordered_json{{"archive", archive.name}, {"answers", true}, {"time_ms", took.count()}}, 1);
  } else {
    put("{} answers and knows us as {} ({:.0f} ms)\n", archive.name, archive.calling, took.count());
  }
}

void remove_archive(const ArchiveOptions& options) {
  const io::Archive archive = archive_named(options.archive.name);
  std::vector<io::Archive> all = read_archives();
  std::erase_if(all, [&](const io::Archive& other) { return other.name == archive.name; });
  write_archives(all);
  put("{} is no longer entered\n", archive.name);
}

void empty_archive_folder() {
  const OnDisk there = fetched_on_disk();
  empty_fetched();
  put("{} series deleted, {} MiB\n", there.series, there.bytes >> 20U);
}

void add_archive_add(CLI::App& command, const std::shared_ptr<ArchiveOptions>& options) {
  CLI::App* add =
      command.add_subcommand("add", "Adds an archive; if there is one of that name, its settings are replaced");
  io::Archive& archive = options->archive;
  add->add_option("NAME", archive.name, "the name of the archive in this program")->required();
  add->add_option("--host", archive.host, "its machine's name or address")->required();
  add->add_option("--port", archive.port, "its DICOM port")->required();
  add->add_option("--called", archive.called, "its AE title")->required();
  add->add_option("--calling", archive.calling, "our AE title, as the archive knows it")->required();
  add->add_flag(
      "--get", archive.uses_get,
      "fetch with C-GET, which the archive must support; by default the archive connects to this machine (C-MOVE)");
  add->add_option("--listen", archive.listen_port, "our port, to which the archive sends (C-MOVE)")
      ->capture_default_str();
  add->add_option("--listen-address", archive.listen_address,
                  "our IPv4 address to listen on for C-MOVE; 0.0.0.0: every address")
      ->capture_default_str();
  add->add_option("--wait", archive.silence_s,
                  "timeout in seconds: give up if the archive does not answer for this long")
      ->capture_default_str();
  add->add_option("--tls-ca", archive.tls.authorities,
                  "use TLS: the certificate (PEM) of the authority that signed the archive's certificate");
  add->add_option("--tls-certificate", archive.tls.certificate,
                  "our own certificate (PEM), if the archive asks for it");
  add->add_option("--tls-name", archive.tls.name,
                  "the host name in the archive's certificate, if it differs from --host");
  add->add_option("--tls-key", archive.tls.key, "the private key of our certificate (PEM, without a pass phrase)");
  add->callback([options] { add_to_settings(*options); });
}

}  // namespace

void add_archive(CLI::App& program) {
  CLI::App* command = program.add_subcommand("archive", "Enters, lists and tests archives (PACS)");
  command->require_subcommand(1);
  const auto options = std::make_shared<ArchiveOptions>();
  add_archive_add(*command, options);
  CLI::App* list =
      command->add_subcommand("list", "Lists the entered archives, and how much fetched data is still there");
  list->add_flag("--json", options->json, "print JSON");
  list->callback([options] { list_archives(*options); });
  CLI::App* echo = command->add_subcommand("echo", "Asks an archive whether it answers and knows us (C-ECHO)");
  echo->add_option("NAME", options->archive.name, "which archive, if several are entered");
  echo->add_flag("--json", options->json, "print JSON");
  echo->callback([options] { echo_archive(*options); });
  CLI::App* remove = command->add_subcommand("remove", "Removes an archive from the settings");
  remove->add_option("NAME", options->archive.name, "which archive")->required();
  remove->callback([options] { remove_archive(*options); });
  command->add_subcommand("empty", "Deletes what `palpate fetch` without -o has fetched")
      ->callback(empty_archive_folder);
}

}  // namespace palpate::plugin
