#pragma once

/// What a client wants to be done, done: another scene, folder or structures, marks, a label map. Of the controlling
/// thread. What takes long (reading, distances) is prepared by another thread, so that the heartbeat goes on. A request
/// changes what is felt along the ramp. It can neither turn the force on nor raise a limit.

#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/received.h"
#include "plugin/openigtlink/server.h"

namespace palpate::plugin::igtl {

/// Another scan, from a folder.
struct LoadedScan {
  std::shared_ptr<const io::Volume> volume;
  ScanFrame frame;
};
/// Throws what loading throws. Called in another thread.
using LoadScan = std::function<LoadedScan(const std::string& folder)>;

/// How the owner of the session changes it. All are called by the controlling thread, and throw why it cannot be done.
struct Changes {
  /// `prepared` is of that scene: offered to the session, what it loaded is not loaded again.
  std::function<void(const modes::Scene& scene, const PreparedScene& prepared)> set_scene;
  std::function<void(const LoadedScan& scan, const modes::Scene& scene, const PreparedScene& prepared)> set_scan;
  std::function<void(const std::vector<Point>& marks)> set_marks;
  LoadScan load;                                          ///< for a folder, in another thread;
  std::function<void(const std::string& folder)> open{};  ///< or this instead, if it is set
};

namespace internal {

/// Files are named by clients of this machine alone: another one's lie elsewhere, and are no business of a stranger.
/// Throws Refusal.
void check_file(const Server::Request& request, const std::string& file);

/// The same for each file that a scene names and the felt scene does not. A structure that is drawn has none.
void check_files(const Server::Request& request, const modes::Scene& wanted, const modes::Scene& felt);

/// Throws Refusal if no scan is open.
void check_scan(bool is_open);

}  // namespace internal

class Requests {
 public:
  /// All have to outlive it. The limits and the stiffness of the session's scene are those that no request can raise:
  /// of the last scene that was not a request's.
  Requests(const LiveSession& session, Server& server, Received& received, Changes changes);
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;
  ~Requests() = default;

  /// Takes what has come, and does what is ready.
  void look();

 private:
  /// What a request comes to, once it is prepared.
  struct Change {
    modes::Scene scene;
    std::optional<LoadedScan> scan = std::nullopt;  ///< none: the scan stays
    PreparedScene prepared = {};                    ///< held until the session has taken it over
    std::string map = {};                           ///< the name of a label map, if it is one,
    std::filesystem::path file = {};                ///< and where it lies now
  };
  using Prepare = std::function<Change()>;

  void begin();
  /// Of copies: the session goes on meanwhile. Empty if nothing changes.
  Prepare work_for(const std::shared_ptr<const Server::Request>& asked);
  void finish(const Change& change);
  void keep_own_limits();
  void answer(std::uint64_t client, Status::Code code, const char* name, const Text& text);
  void refuse(std::uint64_t client, const std::exception& error);
  modes::Scene drawn_down(modes::Scene scene, std::uint64_t client);

  const LiveSession& session_;
  Server& server_;
  Received& received_;
  Changes changes_;
  modes::Limits limits_;
  double stiffness_n_per_m_ = 0;
  std::shared_ptr<const modes::Plan> plan_;  // of the scene that a request set last, or whose limits are kept
  std::deque<std::shared_ptr<const Server::Request>> waiting_;
  std::shared_ptr<const Server::Request> asked_;  // the last that was begun
  std::shared_ptr<const modes::Plan> begun_on_;   // of the scene that it changes: every scene has a plan of its own
  std::future<Change> change_;
  std::string last_told_;
};

}  // namespace palpate::plugin::igtl
