#pragma once

/// Owns the state of the open scan: the contents of the views, the next scan, and the frame. ParaView's time selects
/// the frame. Sections and views follow this model.

#include <QObject>
#include <QString>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/filter.h"
#include "plugin/paraview/client/model/scan_state.h"
#include "plugin/paraview/client/model/scan_world.h"

namespace palpate::plugin {

/// A note or an error message for the caller; empty: none.
struct ScanMessage {
  QString text;
  bool problem = false;
};

class ScanModel : public QObject {
  Q_OBJECT

 public:
  explicit ScanModel(ScanWorld& world, QObject* parent = nullptr) : QObject(parent), world_(world) {}

  const in_views::State& in_views() const { return in_views_; }
  const coming::State& coming() const { return coming_; }
  const ScanMessage& message() const { return message_; }
  /// The scan that is shown and can be felt; null if there is none.
  const ScanHandle* shown() const;
  /// The requested series while its voxels or views are not yet here; none if there is no such request.
  std::optional<SeriesRef> on_its_way() const;
  /// The list to choose from; null if there is none.
  const FoundList* found() const;
  /// The frame that the views show, or will show as soon as its voxels are here; 0 if no scan is shown.
  int wanted_frame() const;
  /// The folder or file that was opened last; empty: none.
  std::string path() const;
  /// The series in the views, whether it can be felt or not; null: none.
  const SeriesRef* seen() const;
  /// Why the views differ from what the stylus would feel, and what to do; empty if they agree.
  QString why_not_felt() const;

  /// How often a scan was requested, with or without success.
  unsigned requests() const { return requests_; }
  /// Finds the series of a folder or file, as the active server names it. Shows it if exactly one of them is a volume.
  void open(const std::string& path);
  /// Shows one of the series that were found.
  void choose(std::size_t series);
  /// Cancels searching, reading or fetching.
  void cancel();
  /// Loads the voxels of another frame in the background; then the views follow.
  void go_to_frame(int frame);
  /// Searches this folder of this machine, too, for a copy of a server's scan, and fetches again.
  void add_copy(const std::string& folder);
  /// `filter` returns the filter that is felt, so that a new frame is filtered from the start.
  void set_filter(std::function<io::Filter()> filter) { filter_ = std::move(filter); }

  /// `may_leave` is called before the user finds or chooses another scan, and again before that scan replaces the open
  /// one, whose data may have been edited meanwhile. If it returns false, the open scan stays.
  void set_may_leave(std::function<bool()> may_leave) { may_leave_ = std::move(may_leave); }

  /// Takes over a reader in the pipeline, with its views, that a state file or Undo has created.
  void restore(const SeriesRef& of, Brought brought);
  /// The reader was deleted from the pipeline.
  void lose();
  /// The server has gone, with everything that it read.
  void lose_server();
  /// ParaView's time has changed.
  void follow_time();

 signals:
  /// Something in the model has changed.
  void changed();
  /// found() has changed.
  void listed();
  void told(const QString& message, bool problem);
  /// The scan that was asked for cannot be read, or is no longer wanted.
  void not_coming();
  /// The contents of the views are about to be removed.
  void leaving();
  /// The scan in the views, or about to be there, cannot be felt: not yet if `why` is empty, otherwise for the reason
  /// `why`. Also emitted when the scan was closed.
  void out_of_reach(const QString& why);
  /// Another scan is in the views, and can be felt.
  void scan_shown(const palpate::plugin::ScanHandle& handle, palpate::plugin::Brought brought);
  /// Another frame of it is in the views, and can be felt.
  void frame_shown(const palpate::plugin::ScanHandle& handle);

 private:
  void tell(const QString& text, bool problem = false);
  void set_coming(coming::State next);
  void set_in_views(in_views::State next);
  void list(const FoundList& found, const std::string& error);
  bool is_of_other_patient(const FoundList& found) const;
  void bring(std::size_t series);
  bool may_leave() const { return !may_leave_ || may_leave_(); }
  void close();
  void leave();
  void begin_showing(const SeriesRef& of, const std::shared_ptr<const io::Volume>& volume);
  void views_made(const std::string& error);
  void fetch(const SeriesRef& of, bool from_server, Brought brought);
  void take_fetched(const ScanWorld::Fetch& fetch);
  void give_up_fetching(const QString& why);
  void take(const ScanHandle& scan, Brought brought);
  void load_frame(int frame);
  void fetch_frame(int frame);
  void take_frame(const std::shared_ptr<const io::Volume>& volume, int frame);
  void note(const SeriesRef& of, const io::Volume* volume);

  ScanWorld& world_;
  in_views::State in_views_;
  coming::State coming_;
  ScanMessage message_;
  std::function<io::Filter()> filter_;
  std::function<bool()> may_leave_;
  std::vector<std::string> copies_;  // of this machine, named by the user
  // The number of the latest request of each kind: answers to others are ignored.
  unsigned requests_ = 0;
  unsigned find_ = 0, views_ = 0, fetch_ = 0, frame_ = 0;
};

}  // namespace palpate::plugin
