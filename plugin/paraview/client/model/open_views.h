#pragma once

/// The views of the scan that is shown. What is drawn in them follows this, and is never handed views by hand.

#include <functional>
#include <list>
#include <memory>
#include <utility>
#include <vector>

class pqRenderView;

namespace palpate::plugin {

class PatientVolume;
class SliceView;

enum class ViewKind { axial, sagittal, coronal, volume };
struct ClinicalView {
  ViewKind kind = ViewKind::volume;
  pqRenderView* view = nullptr;
  SliceView* slice = nullptr;                 ///< null: the volume's. Goes with the view
  std::weak_ptr<PatientVolume> patient = {};  ///< the volume's, where the views have made it
};

/// What lies over what, from below.
enum class Layer { image, outlines, paths, marks, stylus };

/// It outlives those that follow it.
class OpenViews {
 public:
  using Opened = std::function<void(const std::vector<ClinicalView>&)>;
  using SliceShown = std::function<void(SliceView&)>;

  /// Its end ends what follow() began.
  class Following {
   public:
    explicit Following(std::function<void()> end) : end_(std::move(end)) {}
    Following(const Following&) = delete;
    Following& operator=(const Following&) = delete;
    ~Following() { end_(); }

   private:
    std::function<void()> end_;
  };

  OpenViews() = default;
  OpenViews(const OpenViews&) = delete;
  OpenViews& operator=(const OpenViews&) = delete;
  ~OpenViews() = default;

  /// `opened` is called when others are open, and with none before they go; at once where some are. Followers of a
  /// lower layer are called first, and leave last. `slice_shown` is called when a view shows another slice.
  [[nodiscard]] Following follow(Layer layer, Opened opened, SliceShown slice_shown = {});

  /// The views of a scan, of which everything else is there already; empty: they are about to go.
  void set(std::vector<ClinicalView> views);
  const std::vector<ClinicalView>& now() const { return views_; }
  /// A view shows another slice.
  void show_slice(SliceView& slice) const;

 private:
  struct Follower {
    Layer layer = Layer::image;
    Opened opened;
    SliceShown slice_shown;
  };
  std::vector<ClinicalView> views_;
  std::list<Follower> followers_;  // by layer
};

}  // namespace palpate::plugin
