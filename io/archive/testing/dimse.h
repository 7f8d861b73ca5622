#pragma once

/// Messages (PS3.7) and their datasets, for a test archive that breaks the rules as no library would.

#include <cstdint>
#include <map>
#include <string>

namespace palpate::io::testing {

constexpr const char* ct_image = "1.2.840.10008.5.1.4.1.1.2";

using Elements = std::map<std::uint32_t, std::string>;

struct Request {
  int context = 0, field = 0;
  std::uint32_t id = 0;
  std::string sop_class;
  Elements keys;
};

// Elements as text: of a command (implicit VR), and of a dataset (explicit VR with short lengths, which is all that
// these queries and images need).
std::string element(std::uint32_t tag, const std::string& value);
std::string field(std::uint32_t tag, const char* vr, const std::string& value);
Elements parse_implicit(const std::string& text);
Elements parse_explicit(const std::string& text);
std::string uid_of(const std::string& text);  ///< without its padding
/// The elements of a command, preceded by their group length.
std::string with_length(const std::string& elements);

/// A dataset with the elements that identify an image, without pixels.
std::string image(const std::string& instance, const std::string& study, const std::string& series);
std::string store_command(const std::string& instance);

// Functions on a connected socket. They throw Gone if the peer has closed it.
void write_message(int socket, int context, const std::string& command, const std::string& dataset = {});
void respond(int socket, const Request& request, std::uint32_t status, const std::string& dataset = {},
             int completed = 0, int failed = 0);
/// Sends an image; returns the status of the answer.
std::uint32_t store(int socket, int context, const std::string& instance, const std::string& dataset);

/// The presentation context proposed for the class. Throws Gone if there is none.
int context_of(const std::map<int, std::string>& contexts, const std::string& sop_class);

}  // namespace palpate::io::testing
