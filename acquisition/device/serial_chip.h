// SPDX-License-Identifier: Apache-2.0
// Operates a USB device as a serial line: makes the control requests that configure the chip, and
// extracts the payload of its packets. The line has 8 data bits, no parity, 1 stop bit and no flow
// control. Source: [CDC-ACM].
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vitrine::acquisition {

enum class SerialChip { kCdcAcm, kFtdi, kCh34x };

struct ControlRequest {
  std::uint8_t type = 0, request = 0;  // bmRequestType and bRequest; direction: host to device
  std::uint16_t value = 0, index = 0;
  std::vector<std::uint8_t> data = {};

  bool operator==(const ControlRequest&) const = default;
};

// Returns the serial chip of a device, found by vendor and product number. Any other device with
// CDC-ACM interfaces counts as CDC-ACM.
std::optional<SerialChip> chip_by_id(std::uint16_t vendor, std::uint16_t product);

// Returns the requests that configure the chip. `interface` is the control interface of CDC-ACM,
// and 0 for other chips.
std::vector<ControlRequest> set_up(SerialChip chip, int baud, std::uint8_t interface);

// Returns the request that sets DTR and RTS. Arduinos restart on a rising DTR.
ControlRequest modem_lines(SerialChip chip, bool up, std::uint8_t interface);

// Appends the payload of one IN transfer to `out`. The transfer consists of packets of at most
// `packet_size` bytes.
void append_payload(SerialChip chip, std::span<const std::uint8_t> transfer,
                    std::size_t packet_size, std::vector<std::uint8_t>& out);

}  // namespace vitrine::acquisition
