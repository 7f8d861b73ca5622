#pragma once

/// Shared by the tests of clients' requests.

#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "plugin/openigtlink/testing/shared_session.h"

namespace palpate::plugin::igtl::testing {

inline double sent_n(const SharedSession& shared) {
  return glm::length(vector_of(shared.last_tick().sent_n));
}

/// The text of the next STATUS with that name, while the session continues.
inline std::string text_of_status(SharedSession& shared, TestClient& client, const std::string& name) {
  std::optional<Status> status;
  shared.comes([&] { return (status = client.next_status(name, 20)).has_value(); });
  return status ? status->text : "nothing was said";
}

}  // namespace palpate::plugin::igtl::testing
