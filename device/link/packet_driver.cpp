#include "device/link/packet_driver.h"

#include <span>
#include <utility>

namespace palpate::device {

PacketDriver::PacketDriver(std::unique_ptr<Protocol> protocol, LinkMaker make_link)
    : protocol_(std::move(protocol)), make_link_(std::move(make_link)), packet_(protocol_->packet_size()) {}

void PacketDriver::connect() {
  link_ = make_link_();
  try {
    protocol_->connect(*link_);
  } catch (...) {
    link_.reset();
    throw;
  }
}

void PacketDriver::disconnect() noexcept {
  if (link_) protocol_->disconnected(link_->lost());
  link_.reset();
}

void PacketDriver::take(double timeout) noexcept {
  // The newest packet wins; the bound keeps a babbling device from holding the thread.
  std::size_t size = link_->receive(packet_, timeout);
  for (int i = 0; size > 0 && i < 64; ++i) {
    protocol_->receive(std::span(packet_).first(size), link_->now());
    size = link_->receive(packet_, 0);
  }
}

ForceAnswer PacketDriver::give(const Vec3& force) noexcept {
  const std::size_t due = protocol_->step(force, link_->now(), packet_);
  if (due == 0 || !link_->send(std::span(packet_).first(due))) return ForceAnswer::waiting;
  return protocol_->status().withheld ? ForceAnswer::withheld : ForceAnswer::taken;
}

}  // namespace palpate::device
