#pragma once

#include <filesystem>
#include <string>

#include "plugin/openigtlink/testing/peer.h"

namespace palpate::plugin::igtl::testing {

/// An example program of Debian's OpenIGTLink.
class Peer : public Program {
 public:
  Peer(const std::string& example, const std::string& arguments, const std::filesystem::path& output = "/dev/null")
      : Program(std::string(PEERS) + "/peer_" + example, arguments, output) {}
};

}  // namespace palpate::plugin::igtl::testing
