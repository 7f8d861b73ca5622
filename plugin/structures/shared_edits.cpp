#include "plugin/structures/shared_edits.h"

#include <fmt/format.h>

#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "io/errors.h"
#include "io/fields/filtered.h"

namespace palpate::plugin {
namespace {

struct KeptEdit {
  std::weak_ptr<const io::DistanceField> before;
  io::Edit edit;
  std::weak_ptr<const io::Volume> scan;  // that the edit read; of none where it reads none
  std::weak_ptr<const io::DistanceField> after;
};

bool reads_scan(const io::Edit& edit) {
  return std::holds_alternative<io::ScanEdgeEdit>(edit);
}

template <typename Of>
bool is_one(const std::weak_ptr<const Of>& a, const std::shared_ptr<const Of>& b) {
  return !a.owner_before(b) && !b.owner_before(a);
}

std::mutex edits_mutex;
std::vector<KeptEdit> kept_edits;

std::shared_ptr<const io::DistanceField> find_edited(const std::shared_ptr<const io::DistanceField>& before,
                                                     const io::Edit& edit,
                                                     const std::shared_ptr<const io::Volume>& scan) {
  std::erase_if(kept_edits, [](const KeptEdit& one) { return one.before.expired() || one.after.expired(); });
  for (const KeptEdit& one : kept_edits) {
    if (is_one(one.before, before) && one.edit == edit && (!reads_scan(edit) || is_one(one.scan, scan))) {
      if (auto after = one.after.lock()) return after;
    }
  }
  return nullptr;
}

std::shared_ptr<const io::DistanceField> edited_on(const std::shared_ptr<const io::DistanceField>& before,
                                                   const io::Edit& edit,
                                                   const std::shared_ptr<const io::Volume>& scan) {
  if (!reads_scan(edit)) return io::apply_edit(before, edit);
  const auto values = io::edge_fields(io::raw_of(scan));
  const io::ScanValues read{*values, scan->geometry};
  return io::apply_edit(before, edit, {.scan = &read});
}

}  // namespace

std::shared_ptr<const io::DistanceField> shared_edited(const std::shared_ptr<const io::DistanceField>& before,
                                                       const io::Edit& edit,
                                                       const std::shared_ptr<const io::Volume>& scan) {
  // A scan without an owner may be replaced at any time, so it is no key.
  if (reads_scan(edit) && scan.use_count() == 0) return edited_on(before, edit, scan);
  {
    const std::lock_guard lock(edits_mutex);
    if (auto found = find_edited(before, edit, scan)) return found;
  }
  auto made = edited_on(before, edit, scan);
  const std::lock_guard lock(edits_mutex);
  if (auto found = find_edited(before, edit, scan)) return found;  // another thread made it meanwhile
  kept_edits.push_back({before, edit, scan, made});
  return made;
}

std::vector<std::shared_ptr<const io::DistanceField>> shared_edited(std::shared_ptr<const io::DistanceField> before,
                                                                    std::span<const io::Edit> edits,
                                                                    const std::shared_ptr<const io::Volume>& scan) {
  std::vector fields{std::move(before)};
  for (std::size_t n = 0; n < edits.size(); ++n) {
    try {
      fields.push_back(shared_edited(fields.back(), edits[n], scan));
    } catch (const InvalidInput& error) {
      throw InvalidInput(at_place(fmt::format("edit {}", n + 1), error.text()));
    }
  }
  return fields;
}

}  // namespace palpate::plugin
