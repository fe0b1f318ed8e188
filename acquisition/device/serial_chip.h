// SPDX-License-Identifier: Apache-2.0
// How a USB device is used as a serial line: the control requests that set it up, and what of its
// packets is payload. 8 data bits, no parity, 1 stop bit, no flow control.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vitrine {

enum class SerialChip { kCdcAcm, kFtdi, kCh34x };

struct ControlRequest {
  std::uint8_t type = 0, request = 0;  // bmRequestType, bRequest; host to device
  std::uint16_t value = 0, index = 0;
  std::vector<std::uint8_t> data = {};

  bool operator==(const ControlRequest&) const = default;
};

// By vendor and product; any other device that has CDC-ACM's interfaces is taken for one.
std::optional<SerialChip> chip_by_id(std::uint16_t vendor, std::uint16_t product);

// `interface` is CDC-ACM's control interface, 0 elsewhere.
std::vector<ControlRequest> set_up(SerialChip chip, int baud, std::uint8_t interface);

// DTR and RTS. Arduinos restart when DTR rises.
ControlRequest modem_lines(SerialChip chip, bool up, std::uint8_t interface);

// Appends the payload of one IN transfer, which consists of packets of at most `packet_size` bytes.
void append_payload(SerialChip chip, std::span<const std::uint8_t> transfer,
                    std::size_t packet_size, std::vector<std::uint8_t>& out);

}  // namespace vitrine
