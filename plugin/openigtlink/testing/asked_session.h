#pragma once

/// What the tests of clients' requests look at.

#include <glm/geometric.hpp>
#include <optional>
#include <string>

#include "plugin/openigtlink/testing/shared_session.h"

namespace palpate::plugin::igtl::testing {

inline double sent_n(const SharedSession& shared) {
  return glm::length(vector_of(shared.last_tick().sent_n));
}

/// A STATUS that says so by its name, while the session goes on.
inline std::string text_of_status(SharedSession& shared, TestClient& client, const std::string& name) {
  std::optional<Status> status;
  shared.comes([&] { return (status = client.next_status(name, 20)).has_value(); });
  return status ? status->text : "nothing was said";
}

}  // namespace palpate::plugin::igtl::testing
