// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig_board/usb_wire.h"

#include <algorithm>

namespace vitrine::acquisition::rig {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kPacket = 64;

std::uint8_t low(std::size_t value) {
  return static_cast<std::uint8_t>(value & 0xff);
}
std::uint8_t high(std::size_t value) {
  return static_cast<std::uint8_t>(value >> 8 & 0xff);
}

Bytes endpoint(std::uint8_t address, std::uint8_t type) {
  return {7, 5, address, type, low(kPacket), high(kPacket), 1};
}

Bytes interface(std::uint8_t number, std::uint8_t endpoints, std::uint8_t klass,
                std::uint8_t subclass) {
  return {9, 4, number, 0, endpoints, klass, subclass, 0, 0};
}

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts)
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

constexpr std::uint8_t kBulk = 2, kInterrupt = 3;

Bytes interfaces_of(UsbTransport transport) {
  switch (transport) {
    case UsbTransport::kFtdi:
      return joined({interface(0, 2, 0xff, 0xff), endpoint(0x81, kBulk), endpoint(0x02, kBulk)});
    case UsbTransport::kCh34x:
      return joined({interface(0, 3, 0xff, 1), endpoint(0x82, kBulk), endpoint(0x02, kBulk),
                     endpoint(0x81, kInterrupt)});
    case UsbTransport::kCdcAcm:
      break;
  }
  const Bytes header = {5, 0x24, 0, 0x10, 1}, acm = {4, 0x24, 2, 6}, both = {5, 0x24, 6, 0, 1};
  return joined({interface(0, 1, 2, 2), header, acm, both, endpoint(0x82, kInterrupt),
                 interface(1, 2, 10, 0), endpoint(0x04, kBulk), endpoint(0x83, kBulk)});
}

}  // namespace

UsbIds ids_of(UsbTransport transport) {
  switch (transport) {
    case UsbTransport::kFtdi:
      return {0x0403, 0x6001};
    case UsbTransport::kCh34x:
      return {0x1a86, 0x7523};
    case UsbTransport::kCdcAcm:
      break;
  }
  return {0x2341, 0x0043};
}

Bytes descriptors_of(UsbTransport transport) {
  const auto [vendor, product] = ids_of(transport);
  const bool cdc = transport == UsbTransport::kCdcAcm;
  const Bytes interfaces = interfaces_of(transport);
  const std::size_t total = 9 + interfaces.size();
  const std::uint8_t klass = cdc ? 2 : 0, count = cdc ? 2 : 1;
  const Bytes device = {
      18, 1, 0x10, 1, klass, 0, 0, 64, low(vendor), high(vendor), low(product), high(product),
      1,  0, 1,    2, 3,     1};
  const Bytes configuration = {9, 2, low(total), high(total), count, 1, 0, 0x80, 50};
  return joined({device, configuration, interfaces});
}

Bytes string_descriptor(int index, const std::string& serial) {
  if (index == 0) return {4, 3, 0x09, 0x04};
  const std::string text = index == 1 ? "Vitrine" : index == 2 ? "Simulated board" : serial;
  if (index > 3 || text.empty()) return {};
  Bytes bytes = {low(2 + 2 * text.size()), 3};
  for (const char letter : text)
    bytes.insert(bytes.end(), {static_cast<std::uint8_t>(letter), 0});
  return bytes;
}

Setup setup_from(std::span<const std::uint8_t> bytes) {
  const auto word = [&](std::size_t at) {
    return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
  };
  return {
      .type = bytes[0], .request = bytes[1], .value = word(2), .index = word(4), .length = word(6)};
}

std::optional<bool> dtr_in(UsbTransport transport, const Setup& setup) {
  switch (transport) {
    case UsbTransport::kFtdi:
      if (setup.type != 0x40 || setup.request != 1 || (setup.value & 0x100) == 0) return {};
      return (setup.value & 1) != 0;
    case UsbTransport::kCh34x:
      if (setup.type != 0x40 || setup.request != 0xa4) return {};
      return (setup.value & 0x20) == 0;
    case UsbTransport::kCdcAcm:
      break;
  }
  if (setup.type != 0x21 || setup.request != 0x22) return {};
  return (setup.value & 1) != 0;
}

Bytes packets(UsbTransport transport, std::string& pending, std::size_t room) {
  const Bytes status = transport == UsbTransport::kFtdi ? Bytes{0x01, 0x60} : Bytes{};
  Bytes transfer;
  do {
    const std::size_t free = std::min(kPacket, room - transfer.size());
    if (free <= status.size()) break;
    const std::size_t count = std::min(free - status.size(), pending.size());
    transfer.insert(transfer.end(), status.begin(), status.end());
    transfer.insert(transfer.end(), pending.begin(), pending.begin() + static_cast<long>(count));
    pending.erase(0, count);
  } while (!pending.empty());
  return transfer;
}

}  // namespace vitrine::acquisition::rig
