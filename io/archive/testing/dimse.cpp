#include "io/archive/testing/dimse.h"

#include <cstdio>

#include "io/archive/testing/upper_layer.h"

namespace palpate::io::testing {

std::string element(std::uint32_t tag, const std::string& value) {  // implicit VR
  return little(tag >> 16U, 2) + little(tag & 0xFFFFU, 2) + little(static_cast<std::uint32_t>(value.size()), 4) + value;
}

namespace {

/// `length_at`, `length_bytes`: position and size of the length within an element's eight-byte header.
Elements parse(const std::string& text, std::size_t length_at, int length_bytes) {
  Elements result;
  for (std::size_t at = 0; at + 8 <= text.size();) {
    const std::uint32_t tag = number(text, at, 2, false) << 16U | number(text, at + 2, 2, false);
    const std::size_t length = number(text, at + length_at, length_bytes, false);
    result[tag] = text.substr(at + 8, length);
    at += 8 + length;
  }
  return result;
}

}  // namespace

Elements parse_implicit(const std::string& text) {
  return parse(text, 4, 4);
}

Elements parse_explicit(const std::string& text) {
  return parse(text, 6, 2);
}

std::string with_length(const std::string& elements) {
  return element(0x00000000, little(static_cast<std::uint32_t>(elements.size()), 4)) + elements;
}

void write_message(int socket, int context, const std::string& command, const std::string& dataset) {
  write_pdu(socket, 4, pdv(context, true, true, with_length(command)));
  if (!dataset.empty()) write_pdu(socket, 4, pdv(context, false, true, dataset));
}

std::string uid_of(const std::string& text) {
  return text.c_str();
}

void respond(int socket, const Request& request, std::uint32_t status, const std::string& dataset, int completed,
             int failed) {
  std::string command = element(0x00000002, even(request.sop_class)) +
                        element(0x00000100, little(static_cast<std::uint32_t>(request.field) | 0x8000U, 2)) +
                        element(0x00000120, little(request.id, 2)) +
                        element(0x00000800, little(dataset.empty() ? 0x0101 : 0, 2)) +
                        element(0x00000900, little(status, 2));
  if (request.field == 0x10 || request.field == 0x21) {
    command += element(0x00001020, little(0, 2)) +
               element(0x00001021, little(static_cast<std::uint32_t>(completed), 2)) +
               element(0x00001022, little(static_cast<std::uint32_t>(failed), 2)) + element(0x00001023, little(0, 2));
  }
  write_message(socket, request.context, command, dataset);
}

std::string field(std::uint32_t tag, const char* vr, const std::string& value) {
  return little(tag >> 16U, 2) + little(tag & 0xFFFFU, 2) + vr + little(static_cast<std::uint32_t>(value.size()), 2) +
         value;
}

std::string image(const std::string& instance, const std::string& study, const std::string& series) {
  return field(0x00080016, "UI", even(ct_image)) + field(0x00080018, "UI", even(instance)) +
         field(0x0020000D, "UI", even(study)) + field(0x0020000E, "UI", even(series)) + field(0x00200013, "IS", "1 ");
}

std::string store_command(const std::string& instance) {
  return element(0x00000002, even(ct_image)) + element(0x00000100, little(1, 2)) + element(0x00000110, little(77, 2)) +
         element(0x00000700, little(0, 2)) + element(0x00000800, little(0, 2)) + element(0x00001000, even(instance));
}

int context_of(const std::map<int, std::string>& contexts, const std::string& sop_class) {
  for (const auto& [id, name] : contexts) {
    if (name == sop_class) return id;
  }
  throw Gone();
}

std::uint32_t store(int socket, int context, const std::string& instance, const std::string& dataset) {
  write_message(socket, context, store_command(instance), dataset);
  int id = 0;
  Elements answer = parse_implicit(read_part(socket, id));
  const std::uint32_t status = number(answer.at(0x00000900), 0, 2, false);
  std::printf("stored %04X to %u of %s %s\n", status, number(answer.at(0x00000120), 0, 2, false),
              uid_of(answer.at(0x00000002)).c_str(), uid_of(answer.at(0x00001000)).c_str());
  std::fflush(stdout);
  return status;
}

}  // namespace palpate::io::testing
