#pragma once

/// The views of the scan that is shown. Layers that draw into views follow this object; no other code passes them
/// views.

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
  SliceView* slice = nullptr;                 ///< null for the volume view. Deleted with the view
  std::weak_ptr<PatientVolume> patient = {};  ///< of the volume view, once it exists
};

/// Drawing layers, from bottom to top.
enum class Layer { image, outlines, paths, marks, stylus };

/// Must outlive its followers.
class OpenViews {
 public:
  using Opened = std::function<void(const std::vector<ClinicalView>&)>;
  using SliceShown = std::function<void(SliceView&)>;

  /// Its destructor ends the following.
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

  /// `opened` is called with the views when they open, without views before they close, and at once if some are open.
  /// Followers of a lower layer are called first on opening, and last on closing. `slice_shown` is called when a view
  /// shows another slice.
  [[nodiscard]] Following follow(Layer layer, Opened opened, SliceShown slice_shown = {});

  /// Called when everything else of a scan is ready. Empty: the views are about to close.
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
