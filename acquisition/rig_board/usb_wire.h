// SPDX-License-Identifier: Apache-2.0
// Descriptors, control requests and packet framing of the simulated USB devices. All functions are
// pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vitrine::acquisition::rig {

enum class UsbTransport { kCdcAcm, kFtdi, kCh34x };

struct UsbIds {
  std::uint16_t vendor = 0, product = 0;
};
// Returns the USB numbers of an Arduino Uno, an FT232R or a CH340.
UsbIds ids_of(UsbTransport transport);

// Returns the device and configuration descriptors in the format of the kernel's `descriptors`
// file.
std::vector<std::uint8_t> descriptors_of(UsbTransport transport);
// Returns string descriptor 0 (languages) or 1 to 3. Empty if there is no such descriptor.
std::vector<std::uint8_t> string_descriptor(int index, const std::string& serial);

struct Setup {
  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0, length = 0;
};
Setup setup_from(std::span<const std::uint8_t> bytes);  // `bytes` must have at least 8 bytes

// Returns the state of DTR that a request sets, or nullopt if the request does not set DTR.
std::optional<bool> dtr_in(UsbTransport transport, const Setup& setup);

// Removes from `pending` as many bytes as fit into one IN transfer of `room` bytes. Returns the
// transfer with these bytes.
std::vector<std::uint8_t> packets(UsbTransport transport, std::string& pending, std::size_t room);

}  // namespace vitrine::acquisition::rig
