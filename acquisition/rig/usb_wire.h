// SPDX-License-Identifier: Apache-2.0
// What tells the simulated USB devices apart: descriptors, control requests, framing. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vitrine::rig {

enum class UsbTransport { kCdcAcm, kFtdi, kCh34x };

struct UsbIds {
  std::uint16_t vendor = 0, product = 0;
};
// An Arduino Uno, an FT232R, a CH340.
UsbIds ids_of(UsbTransport transport);

// Device and configuration descriptor as the kernel's `descriptors` file has them.
std::vector<std::uint8_t> descriptors_of(UsbTransport transport);
// Of index 0 (languages) and 1 to 3; empty: there is none.
std::vector<std::uint8_t> string_descriptor(int index, const std::string& serial);

struct Setup {
  std::uint8_t type = 0, request = 0;
  std::uint16_t value = 0, index = 0, length = 0;
};
Setup setup_from(std::span<const std::uint8_t> bytes);  // at least 8

// What a request says of DTR; nothing where it is about something else.
std::optional<bool> dtr_in(UsbTransport transport, const Setup& setup);

// Takes as much of `pending` as fits into one IN transfer of `room` bytes.
std::vector<std::uint8_t> packets(UsbTransport transport, std::string& pending, std::size_t room);

}  // namespace vitrine::rig
