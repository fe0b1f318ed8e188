// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/serial_chip.h"

#include <algorithm>
#include <array>

namespace vitrine::acquisition {
namespace {

ControlRequest vendor_request(std::uint8_t request, std::uint32_t value, std::uint32_t index) {
  return {.type = 0x40,  // a vendor request to the device
          .request = request,
          .value = static_cast<std::uint16_t>(value),
          .index = static_cast<std::uint16_t>(index)};
}

ControlRequest class_request(std::uint8_t request, std::uint16_t value, std::uint8_t interface) {
  return {.type = 0x21,  // a CDC-ACM request to the interface
          .request = request,
          .value = value,
          .index = interface};
}

// Returns the request that sets the baud rate of an FT232R. The chip divides 3 MHz by a multiple of
// 1/8; the eighths are coded in bits 14 and 15, and in the index.
ControlRequest ftdi_baud(int baud) {
  constexpr std::array<std::uint32_t, 8> kEighths = {0, 3, 2, 4, 1, 5, 6, 7};
  const std::uint32_t eighths = (24'000'000u + static_cast<std::uint32_t>(baud) / 2) / baud;
  const std::uint32_t divisor = eighths >> 3 | kEighths[eighths & 7] << 14;
  return vendor_request(3, divisor, divisor >> 16);
}

std::vector<ControlRequest> ftdi_set_up(int baud) {
  return {vendor_request(0, 0, 0),   // resets the chip
          ftdi_baud(baud),           //
          vendor_request(4, 8, 0),   // sets 8 data bits, no parity, 1 stop bit
          vendor_request(2, 0, 0),   // disables flow control
          vendor_request(9, 1, 0)};  // sets the latency to 1 ms
}

// Returns the divisor register of CH340 and CH341 for a baud rate. Its high byte is the upper byte
// of the start value of a 16-bit counter. Its two lowest bits, p, select the prescaler 8^(3 - p).
std::uint16_t ch34x_divisor(int baud) {
  std::uint32_t factor = 1'532'620'800u / static_cast<std::uint32_t>(baud);
  std::uint32_t prescaler = 3;
  for (; factor > 0xfff0 && prescaler > 0; --prescaler)
    factor >>= 3;
  factor = 0x10000 - factor;
  return static_cast<std::uint16_t>((factor & 0xff00) | prescaler | 0x80);
}

std::vector<ControlRequest> ch34x_set_up(int baud) {
  return {
      vendor_request(0xa1, 0, 0),                         // starts the serial line
      vendor_request(0x9a, 0x1312, ch34x_divisor(baud)),  // sets divisor and prescaler
      vendor_request(0x9a, 0x2518, 0x00c3)};  // enables both directions; 8 data bits, 1 stop bit
}

std::vector<ControlRequest> cdc_set_up(int baud, std::uint8_t interface) {
  const auto rate = static_cast<std::uint32_t>(baud);
  const auto byte = [rate](int shift) { return static_cast<std::uint8_t>(rate >> shift); };
  ControlRequest line_coding = class_request(0x20, 0, interface);
  line_coding.data = {byte(0), byte(8), byte(16), byte(24),
                      0,       0,       8};  // 1 stop bit, no parity, 8 data bits
  return {line_coding};
}

}  // namespace

std::optional<SerialChip> chip_by_id(std::uint16_t vendor, std::uint16_t product) {
  if (vendor == 0x0403) return SerialChip::kFtdi;
  constexpr std::array<std::uint16_t, 4> kCh34x = {0x7523, 0x7522, 0x5523, 0xe523};
  if (vendor == 0x1a86 && std::find(kCh34x.begin(), kCh34x.end(), product) != kCh34x.end())
    return SerialChip::kCh34x;
  return std::nullopt;
}

std::vector<ControlRequest> set_up(SerialChip chip, int baud, std::uint8_t interface) {
  switch (chip) {
    case SerialChip::kFtdi:
      return ftdi_set_up(baud);
    case SerialChip::kCh34x:
      return ch34x_set_up(baud);
    case SerialChip::kCdcAcm:
      break;
  }
  return cdc_set_up(baud, interface);
}

ControlRequest modem_lines(SerialChip chip, bool up, std::uint8_t interface) {
  switch (chip) {
    case SerialChip::kFtdi:
      return vendor_request(1, up ? 0x0303 : 0x0300, 0);
    case SerialChip::kCh34x:
      return vendor_request(0xa4, up ? ~0x60u : ~0u, 0);
    case SerialChip::kCdcAcm:
      break;
  }
  return class_request(0x22, up ? 3 : 0, interface);
}

void append_payload(SerialChip chip, std::span<const std::uint8_t> transfer,
                    std::size_t packet_size, std::vector<std::uint8_t>& out) {
  // Each packet of an FTDI chip starts with two bytes: the states of the modem and of the line.
  constexpr std::size_t kFtdiStatus = 2;
  const std::size_t skip = chip == SerialChip::kFtdi ? kFtdiStatus : 0;
  for (std::size_t at = 0; at < transfer.size(); at += packet_size) {
    const auto packet = transfer.subspan(at, std::min(packet_size, transfer.size() - at));
    if (packet.size() > skip) out.insert(out.end(), packet.begin() + skip, packet.end());
  }
}

}  // namespace vitrine::acquisition
