#pragma once

/// Whether a change of a structure keeps its parts: finds the nodes of parts that appear, vanish, join or divide.

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace palpate::io::internal {

/// `before`, `after`: for each node, i fastest, whether it is inside. A part is a set of nodes connected along the
/// axes, inside or outside. Returns the nodes of all parts without a partner. Two parts are partners if each shares
/// most of its nodes with the other.
std::vector<std::size_t> nodes_of_other_parts(const glm::ivec3& size, const std::vector<char>& before,
                                              const std::vector<char>& after);

}  // namespace palpate::io::internal
