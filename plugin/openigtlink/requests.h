#pragma once

/// Carries out the requests of clients: another scene, folder or structures, marks, a label map. For the controlling
/// thread. Slow parts (reading, distances) are prepared in another thread, so that the heartbeat continues. A request
/// changes the force along the ramp. It can neither turn the force on nor raise a limit, and does not undo what the
/// owner does after it came.

#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/job.h"
#include "plugin/openigtlink/received.h"
#include "plugin/openigtlink/server.h"

namespace palpate::plugin::igtl {

/// Another scan, from a folder.
struct LoadedScan {
  std::shared_ptr<const io::Volume> volume;
  ScanFrame frame;
};
/// Throws errors of loading, and io::Cancelled. Called in another thread.
using LoadScan = std::function<LoadedScan(const std::string& folder, const io::Progress& progress)>;

/// The owner's functions to change the session. They are called by the controlling thread, and throw the reason if a
/// change is impossible.
struct Changes {
  /// `prepared` is for that scene: after offering it to the session, nothing is loaded again.
  std::function<void(const modes::Scene& scene, const PreparedScene& prepared)> set_scene;
  std::function<void(const LoadedScan& scan, const modes::Scene& scene, const PreparedScene& prepared)> set_scan;
  std::function<void(const std::vector<Point>& marks)> set_marks;
  LoadScan load;                                          ///< for a folder, in another thread;
  std::function<void(const std::string& folder)> open{};  ///< or this instead, if it is set
  /// Whether the session's scene is the owner's latest. While a change of the owner is still on its way, no request
  /// takes effect. Always, if it is empty.
  std::function<bool()> is_settled{};
  /// Whether a client's scene is felt with the session's own workspace: another one would move an armed stylus through
  /// the patient.
  bool keeps_workspace = false;
};

/// The scene with limits and stiffness that are not looser than these.
modes::Scene tightened(modes::Scene scene, const modes::Limits& limits, double stiffness_n_per_m);

namespace internal {

/// Only clients on this machine may name files: the paths of others mean other files, and must not be probed. Throws
/// Refusal.
void check_file(const Server::Request& request, const std::string& file);

/// The same for each file that a scene names and the felt scene does not. A structure defined by contours has none.
void check_files(const Server::Request& request, const modes::Scene& wanted, const modes::Scene& felt);

/// Throws Refusal if no scan is open.
void check_scan(bool is_open);

}  // namespace internal

class Requests {
 public:
  /// The arguments must outlive it. No request can raise the limits and the stiffness of the latest scene that did not
  /// come from a request.
  Requests(const LiveSession& session, Server& server, Received& received, JobThreads& threads, Changes changes);
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;
  ~Requests() = default;

  /// Takes new requests, and carries out those that are ready.
  void look();

 private:
  /// The changes of a request, once it is prepared.
  struct Change {
    modes::Scene scene;
    std::optional<LoadedScan> scan = std::nullopt;  ///< none: the scan stays
    PreparedScene prepared = {};                    ///< kept until the session has taken it over
    std::string map = {};                           ///< name of the label map, if the request is one
    std::filesystem::path file = {};                ///< and its present file
  };
  using Prepare = Job<Change>::Work;

  void begin();
  /// Works on copies, because the session continues meanwhile. Empty if nothing changes.
  Prepare work_for(const std::shared_ptr<const Server::Request>& asked);
  /// Whether a request is being prepared or waits to take effect.
  bool is_busy() const { return change_.is_busy() || prepared_; }
  /// Refuses what cannot be prepared, and lets the rest take effect when the owner's changes are through.
  void end_prepared();
  void finish(const Change& change);
  void begin_again();
  void check_owners_scene(const Server::Request& request, const modes::Scene& named) const;
  /// Notes what the owner changes: limits, and the scene.
  void follow_owner();
  void answer(std::uint64_t client, Status::Code code, const char* name, const Text& text);
  void refuse(std::uint64_t client, const std::exception& error);
  modes::Scene drawn_down(const modes::Scene& scene, std::uint64_t client);
  modes::Scene in_own_workspace(const modes::Scene& scene, std::uint64_t client);

  const LiveSession& session_;
  Server& server_;
  Received& received_;
  Changes changes_;
  modes::Limits limits_;
  double stiffness_n_per_m_ = 0;
  std::shared_ptr<const modes::Plan> plan_;  // of the scene that was looked at last
  std::deque<std::shared_ptr<const Server::Request>> waiting_;
  std::shared_ptr<const Server::Request> asked_;     // the latest one begun
  std::shared_ptr<const modes::Plan> begun_on_;      // of the scene that it changes: every scene has its own plan
  int restarts_ = 0;                                 // of the latest one
  std::string scene_;                                // the session's, as text
  std::shared_ptr<const std::string> owners_scene_;  // the latest one that did not come from a request
  Job<Change> change_;
  std::optional<Change> prepared_;  // waits until the owner's changes are through
  std::string last_told_;
};

}  // namespace palpate::plugin::igtl
