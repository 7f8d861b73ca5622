#include "plugin/openigtlink/requests.h"

#include <algorithm>
#include <utility>

#include "io/errors.h"
#include "io/structures/structure.h"
#include "modes/scene/scene_json.h"
#include "plugin/messages/tell.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/names.h"
#include "plugin/openigtlink/say.h"
#include "plugin/structures/study_structures.h"

namespace palpate::plugin::igtl {
namespace {

constexpr int most_restarts = 4;

/// The session as it is when the work begins.
struct Base {
  Prepared before;
  std::shared_ptr<const io::Volume> scan;
  glm::dvec3 half_extent_m{0};

  PreparedScene prepared(const modes::Scene& scene) const { return prepare(scene, scan, half_extent_m, before); }
  const modes::Scene& scene() const { return before.scene; }
};

/// The scene with a boundary at the edge of each structure that it does not name yet.
modes::Scene with_boundaries(modes::Scene scene, const std::vector<io::Structure>& structures) {
  for (const io::Structure& structure : structures) {
    const bool known = std::ranges::any_of(
        scene.structures, [&](const modes::SceneStructure& named) { return is_same(named, structure); });
    if (!known && structure.unfit.empty()) add_boundary_of(scene, structure);
  }
  return scene;
}

/// The same for a label map: references to the previous map become references to the new one.
modes::Scene with_map(modes::Scene scene, const std::string& name, const std::filesystem::path& before,
                      const std::filesystem::path& file, const io::Progress& progress) {
  std::vector<io::Structure> structures = io::find_structures(std::vector{file}, progress).structures;
  if (std::ranges::none_of(structures, [](const io::Structure& one) { return one.unfit.empty(); })) {
    throw Refusal(say("igtl-no-labels", name));
  }
  for (modes::SceneStructure& structure : scene.structures) {
    if (!before.empty() && structure.file == before.string()) structure.file = file.string();
  }
  for (io::Structure& structure : structures) {
    structure.name = structures.size() == 1 ? name : name + " " + std::to_string(structure.number);
  }
  return with_boundaries(std::move(scene), structures);
}

/// A map that is not felt is not kept.
void remove_file(const std::filesystem::path& file) {
  std::error_code none;
  if (!file.empty()) std::filesystem::remove(file, none);
}

bool is_named(const modes::Scene& scene, const std::string& file) {
  return std::ranges::any_of(scene.structures, [&](const auto& structure) { return structure.file == file; });
}

}  // namespace

void internal::check_file(const Server::Request& request, const std::string& file) {
  if (!request.from_this_machine) throw Refusal(say("igtl-file-from-elsewhere", file));
}

void internal::check_files(const Server::Request& request, const modes::Scene& wanted, const modes::Scene& felt) {
  for (const modes::SceneStructure& structure : wanted.structures) {
    const bool drawn = structure.file.empty();
    if (!drawn && !is_named(felt, structure.file)) check_file(request, structure.file);
  }
}

void internal::check_scan(bool is_open) {
  if (!is_open) throw Refusal(say("igtl-no-scan"));
}

modes::Scene tightened(modes::Scene scene, const modes::Limits& limits, double stiffness_n_per_m) {
  modes::Limits& own = scene.limits;
  own.force_n = std::min(own.force_n, limits.force_n);
  own.slew_n_per_ms = std::min(own.slew_n_per_ms, limits.slew_n_per_ms);
  own.ramp_s = std::max(own.ramp_s, limits.ramp_s);
  own.speed_m_per_s = std::min(own.speed_m_per_s, limits.speed_m_per_s);
  scene.stiffness_n_per_m = std::min(scene.stiffness_n_per_m, stiffness_n_per_m);
  return scene;
}

Requests::Requests(const LiveSession& session, Server& server, Received& received, JobThreads& threads, Changes changes)
    : session_(session), server_(server), received_(received), changes_(std::move(changes)), change_(threads) {
  follow_owner();
}

void Requests::follow_owner() {
  if (plan_ && plan_ == session_.plan()) return;
  plan_ = session_.plan();
  std::string scene = modes::to_json(session_.scene());
  if (owners_scene_ && scene == scene_) return;  // another frame of the scan
  scene_ = std::move(scene);
  owners_scene_ = std::make_shared<const std::string>(scene_);
  server_.set_owners_scene(owners_scene_);
  limits_ = session_.scene().limits;
  stiffness_n_per_m_ = session_.scene().stiffness_n_per_m;
}

void Requests::look() {
  follow_owner();
  end_prepared();
  if (is_busy()) return;
  // New requests wait in the server, where the newest replaces earlier ones.
  if (waiting_.empty()) {
    for (Server::Request& request : server_.take()) {
      waiting_.push_back(std::make_shared<const Server::Request>(std::move(request)));
    }
  }
  while (!waiting_.empty() && !is_busy()) {
    asked_ = std::move(waiting_.front());
    waiting_.pop_front();
    restarts_ = 0;
    begin();
  }
  if (!is_busy()) asked_.reset();  // its bytes are free for others
}

void Requests::end_prepared() {
  try {
    if (change_.is_ready()) prepared_ = change_.take();
    if (!prepared_ || (changes_.is_settled && !changes_.is_settled())) return;
    const Change change = *std::exchange(prepared_, std::nullopt);
    finish(change);
  } catch (const std::exception& error) {
    refuse(asked_->client, error);
  }
}

void Requests::begin() {
  try {
    if (asked_->message.type == "POINT") {
      changes_.set_marks(points_of(asked_->message.content));
    } else if (const Prepare work = work_for(asked_)) {
      begun_on_ = session_.plan();
      change_.start(work);
    }
  } catch (const std::exception& error) {
    refuse(asked_->client, error);
  }
}

Requests::Prepare Requests::work_for(const std::shared_ptr<const Server::Request>& asked) {
  const Server::Request& request = *asked;
  const Base base{{.felt = session_.felt(), .scene = session_.scene()},
                  session_.scan(),
                  session_.planned_for().workspace_half_extent};
  const Message& message = request.message;
  if (message.device != folder_name) internal::check_scan(base.scan != nullptr);
  if (message.type == "IMAGE") {
    const std::filesystem::path before = received_.file_of(message.device), file = received_.fresh_file(message.device);
    return [base, before, file, asked](const io::Progress& progress) {
      try {
        write_nrrd(image_of(asked->message.content), file);
        const modes::Scene scene = with_map(base.scene(), asked->message.device, before, file, progress);
        Change change{.scene = scene, .prepared = base.prepared(scene), .map = asked->message.device, .file = file};
        if (!progress(1)) throw io::Cancelled();
        return change;
      } catch (...) {
        remove_file(file);
        throw;
      }
    };
  }
  const std::string text = string_of(message.content);
  if (message.device == scene_name) {
    const modes::Scene named = received_.with_files(modes::scene_from_json(text, scene_name));
    internal::check_files(request, named, base.scene());
    check_owners_scene(request, named);
    const modes::Scene scene = drawn_down(in_own_workspace(named, request.client), request.client);
    // A client that sends its copy whenever it changes also sends back what it received; as a change this would never
    // end.
    if (modes::to_json(scene) == modes::to_json(base.scene())) return {};
    return [base, scene](const io::Progress& /*progress*/) {
      return Change{.scene = scene, .prepared = base.prepared(scene)};
    };
  }
  internal::check_file(request, text);
  if (message.device == folder_name && changes_.open) {
    changes_.open(text);
    return {};
  }
  if (message.device == folder_name) {
    return [base, text, load = changes_.load](const io::Progress& progress) {
      const LoadedScan scan = load(text, progress);
      return Change{
          .scene = base.scene(), .scan = scan, .prepared = prepare(base.scene(), scan.volume, base.half_extent_m)};
    };
  }
  return [base, text](const io::Progress& progress) {
    const auto structures = io::find_structures(std::vector<std::filesystem::path>{text}, progress).structures;
    if (structures.empty()) throw Refusal(say("igtl-no-labels", text));
    const modes::Scene scene = with_boundaries(base.scene(), structures);
    return Change{.scene = scene, .prepared = base.prepared(scene)};
  };
}

/// The owner has changed the scene since the request came: a whole scene of before would undo that.
void Requests::check_owners_scene(const Server::Request& request, const modes::Scene& named) const {
  const bool is_older = request.owners_scene && *request.owners_scene != *owners_scene_;
  if (is_older && modes::to_json(named) != scene_) throw Refusal(say("igtl-scene-is-older"));
}

/// The owner has changed scene or scan while it was prepared. While the frames of a scan play, that has no end.
void Requests::begin_again() {
  if (restarts_ == most_restarts) throw Refusal(say("igtl-keeps-changing", restarts_ + 1));
  ++restarts_;
  begin();
}

void Requests::finish(const Change& change) {
  if (begun_on_ != session_.plan()) {
    remove_file(change.file);
    return begin_again();
  }
  const modes::Scene scene = drawn_down(change.scene, asked_->client);
  try {
    if (change.scan) {
      changes_.set_scan(*change.scan, scene, change.prepared);
    } else {
      changes_.set_scene(scene, change.prepared);
    }
  } catch (...) {
    remove_file(change.file);
    throw;
  }
  if (!change.map.empty()) received_.use(change.map, change.file);
  scene_ = modes::to_json(session_.scene());
}

modes::Scene Requests::drawn_down(const modes::Scene& scene, std::uint64_t client) {
  modes::Scene tight = tightened(scene, limits_, stiffness_n_per_m_);
  const modes::Limits &limits = tight.limits, &asked = scene.limits;
  const bool same = limits.force_n == asked.force_n && limits.slew_n_per_ms == asked.slew_n_per_ms &&
                    limits.ramp_s == asked.ramp_s && limits.speed_m_per_s == asked.speed_m_per_s &&
                    tight.stiffness_n_per_m == scene.stiffness_n_per_m;
  if (!same) answer(client, Status::Code::configuration_error, "drawn down", say("igtl-limits-stay"));
  return tight;
}

modes::Scene Requests::in_own_workspace(const modes::Scene& scene, std::uint64_t client) {
  if (!changes_.keeps_workspace) return scene;
  modes::Scene kept = scene;
  kept.workspace = session_.scene().workspace;
  if (modes::to_json(kept) != modes::to_json(scene)) {
    answer(client, Status::Code::configuration_error, "workspace stays", say("igtl-workspace-stays"));
  }
  return kept;
}

void Requests::answer(std::uint64_t client, Status::Code code, const char* name, const Text& text) {
  Bytes wire;
  append(wire, {.type = "STATUS",
                .device = program_name,
                .content = content_of(Status{.code = code, .name = name, .text = text})});
  server_.answer(client, name, std::move(wire));
  if (last_told_ == text) return;  // a client may say the same without end
  last_told_ = text;
  tell(text);
}

void Requests::refuse(std::uint64_t client, const std::exception& error) {
  answer(client, Status::Code::configuration_error, "refused", say("igtl-refused", error.what()));
}

}  // namespace palpate::plugin::igtl
