#pragma once

/// Hands objects from the controlling thread to the servo, and back when the servo no longer uses them. So the servo
/// never allocates, frees or waits.

#include <atomic>
#include <memory>
#include <utility>

namespace palpate::plugin {

/// T has a member `T* next_returned`. One giver and one taker.
template <typename T>
class Handover {
 public:
  Handover() = default;
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;
  ~Handover() {
    give(nullptr);
    collect();
  }

  /// Giver: offers an item. It replaces one that was offered and not taken.
  void give(std::unique_ptr<T> item) { const std::unique_ptr<T> replaced(offered_.exchange(item.release())); }

  /// Taker, wait-free: the offered item, which the taker now owns; null if there is none.
  T* take() noexcept { return is_offered() ? offered_.exchange(nullptr, std::memory_order_acq_rel) : nullptr; }
  bool is_offered() const noexcept { return offered_.load(std::memory_order_acquire) != nullptr; }

  /// Taker: hands back an item, for the giver to free. Waits at most for a collect() that runs at the same instant.
  void give_back(T* item) noexcept {
    item->next_returned = returned_.load(std::memory_order_relaxed);
    while (!returned_.compare_exchange_weak(item->next_returned, item, std::memory_order_release,
                                            std::memory_order_relaxed)) {
    }
  }

  /// Giver: frees what was handed back. Returns whether there was anything.
  bool collect() {
    T* item = returned_.exchange(nullptr, std::memory_order_acquire);
    const bool any = item != nullptr;
    while (item != nullptr) {
      const std::unique_ptr<T> freed(item);
      item = freed->next_returned;
    }
    return any;
  }

 private:
  std::atomic<T*> offered_{nullptr};
  std::atomic<T*> returned_{nullptr};
};

}  // namespace palpate::plugin
