#include "plugin/app/archive_settings.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "plugin/app/archive_json.h"
#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json to_json(const io::Archive& archive) {
  Json json = connection_json(archive);
  json["silence_s"] = archive.silence_s;
  if (archive.tls.used) {
    json["tls"] = {{"authorities", archive.tls.authorities.string()},
                   {"certificate", archive.tls.certificate.string()},
                   {"key", archive.tls.key.string()}};
    if (!archive.tls.name.empty()) json["tls"]["name"] = archive.tls.name;
  }
  return json;
}

io::Archive from_json(const Json& json) {
  io::Archive archive;
  archive.name = json.at("name").get<std::string>();
  archive.host = json.at("host").get<std::string>();
  archive.port = json.at("port").get<int>();
  archive.called = json.at("called").get<std::string>();
  archive.calling = json.at("calling").get<std::string>();
  archive.uses_get = json.at("get").get<bool>();
  archive.listen_address = json.at("listen_address").get<std::string>();
  archive.listen_port = json.at("listen_port").get<int>();
  archive.silence_s = json.at("silence_s").get<int>();
  if (json.contains("tls")) {
    const Json& tls = json.at("tls");
    archive.tls = {true, tls.at("authorities").get<std::string>(), tls.at("certificate").get<std::string>(),
                   tls.at("key").get<std::string>(), tls.value("name", std::string())};
  }
  io::check(archive);
  return archive;
}

[[noreturn]] void cannot_write(const fs::path& file, const std::string& why) {
  throw InputRefused(say("settings-cannot-be-written", file.string(), why));
}

void write_private(const fs::path& file, const std::string& text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (descriptor < 0) cannot_write(file, std::generic_category().message(errno));
  fchmod(descriptor, 0600);
  const bool whole = write(descriptor, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int error = errno;
  if (close(descriptor) != 0 || !whole) cannot_write(file, std::generic_category().message(whole ? errno : error));
}

}  // namespace

nlohmann::ordered_json connection_json(const io::Archive& archive) {
  return {{"name", archive.name},
          {"host", archive.host},
          {"port", archive.port},
          {"called", archive.called},
          {"calling", archive.calling},
          {"get", archive.uses_get},
          {"listen_address", archive.listen_address},
          {"listen_port", archive.listen_port}};
}

// A variable that is empty or no absolute path counts as not set.
fs::path user_folder(const char* variable, const char* under_home) {
  const char* const named = std::getenv(variable);
  if (named != nullptr && named[0] == '/') return fs::path(named) / "palpate";
  const char* const home = std::getenv("HOME");
  if (home == nullptr || home[0] != '/') {
    throw InputRefused(say("neither-nor-home-names-a-folder", variable));
  }
  return fs::path(home) / under_home / "palpate";
}

fs::path archive_settings_file() {
  return user_folder("XDG_CONFIG_HOME", ".config") / "archives.json";
}

std::vector<io::Archive> read_archives() {
  const fs::path file = archive_settings_file();
  if (!fs::exists(file)) return {};
  std::vector<io::Archive> archives;
  try {
    std::ifstream stream(file);
    const Json json = Json::parse(stream);
    for (const Json& one : json.at("archives")) archives.push_back(from_json(one));
  } catch (const std::exception& error) {
    throw InputRefused(say("settings-cannot-be-read", file.string(), error.what()));
  }
  return archives;
}

void write_archives(const std::vector<io::Archive>& archives) {
  const fs::path file = archive_settings_file();
  std::error_code error;
  const bool made = fs::create_directories(file.parent_path(), error);
  if (error) cannot_write(file, error.message());
  if (made) fs::permissions(file.parent_path(), fs::perms::owner_all, error);
  Json json{{"archives", Json::array()}};
  for (const io::Archive& archive : archives) json["archives"].push_back(to_json(archive));
  const fs::path next = file.string() + ".new";
  write_private(next, json.dump(1) + "\n");
  fs::rename(next, file, error);
  if (error) cannot_write(file, error.message());
}

io::Archive archive_named(const std::string& name) {
  const std::vector<io::Archive> archives = read_archives();
  if (archives.empty()) {
    throw InputRefused(say("no-archive-is-entered-yet"));
  }
  if (name.empty() && archives.size() == 1) return archives.front();
  std::string names;
  for (const io::Archive& archive : archives) {
    if (archive.name == name) return archive;
    names += (names.empty() ? "" : ", ") + archive.name;
  }
  if (name.empty()) throw InputRefused(say("choose-one-of-the-archives-with-archive", names));
  throw InputRefused(say("no-archive-is-entered", name, names));
}

}  // namespace palpate::plugin
