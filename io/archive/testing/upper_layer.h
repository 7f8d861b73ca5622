#pragma once

/// DICOM's upper layer (PS3.8), byte by byte, for a test archive that breaks the rules as no library would.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace palpate::io::testing {

struct Gone : std::runtime_error {
  explicit Gone(int pdu = 0) : std::runtime_error("the peer is gone"), type(pdu) {}
  int type;  ///< of the PDU that ended the connection; 0: none did
};

struct Pdu {
  int type = 0;
  std::string body;
};

// Numbers of `bytes` bytes, highest or lowest byte first.
std::string big(std::uint32_t value, int bytes);
std::string little(std::uint32_t value, int bytes);
std::uint32_t number(const std::string& text, std::size_t at, int bytes, bool is_big);
std::string even(std::string text, char pad = '\0');

// Writes all bytes; throws Gone if the peer has closed the socket.
void write_all(int socket, const std::string& bytes);
std::string read_all(int socket, std::size_t count);
Pdu read_pdu(int socket);
void write_pdu(int socket, int type, const std::string& body);

std::string item(int type, const std::string& body);
/// The items of a body from the offset `at` on: type and content.
std::vector<std::pair<int, std::string>> items(const std::string& body, std::size_t at);
/// Answers the request for an association: accepts each context with its first transfer syntax, or rejects all. Returns
/// the class of each context, by number.
std::map<int, std::string> accept(int socket, const std::string& request, bool agrees);
/// A presentation data value (PDV): a fragment of a message.
std::string pdv(int context, bool command, bool last, const std::string& bytes);
/// A part of a message (command or dataset) from its first PDU to its last, with a pause before each PDU.
std::string read_part(int socket, int& context, std::chrono::microseconds pause = {});

}  // namespace palpate::io::testing
