#pragma once

/// DICOM's upper layer (PS3.8), byte by byte, for an archive that violates the standard as no library would.

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
  int type;  ///< type of the PDU that ended it; 0: none
};

struct Pdu {
  int type = 0;
  std::string body;
};

// Numbers of so many bytes, in big-endian or little-endian order.
std::string big(std::uint32_t value, int bytes);
std::string little(std::uint32_t value, int bytes);
std::uint32_t number(const std::string& text, std::size_t at, int bytes, bool is_big);
std::string even(std::string text, char pad = '\0');

// Reads or writes all bytes, or throws Gone.
void write_all(int socket, const std::string& bytes);
std::string read_all(int socket, std::size_t count);
Pdu read_pdu(int socket);
void write_pdu(int socket, int type, const std::string& body);

std::string item(int type, const std::string& body);
/// The items of a body from an offset on: type and content.
std::vector<std::pair<int, std::string>> items(const std::string& body, std::size_t at);
/// Accepts an association: each context with its first transfer syntax, or none of them. Returns the contexts' classes
/// by number.
std::map<int, std::string> accept(int socket, const std::string& request, bool agrees);
/// A part of a message.
std::string pdv(int context, bool command, bool last, const std::string& bytes);
/// Reads a command or a dataset, from its first PDU to its last, with a pause before each.
std::string read_part(int socket, int& context, std::chrono::microseconds pause = {});

}  // namespace palpate::io::testing
