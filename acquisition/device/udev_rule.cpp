// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/udev_rule.h"

#include <fmt/format.h>

#include "acquisition/device/serial_chip.h"

namespace vitrine::acquisition {

bool has_udev_rule(std::uint16_t vendor, std::uint16_t product) {
  constexpr std::uint16_t kArduino = 0x2341, kArduinoToo = 0x2a03;
  if (vendor == kArduino || vendor == kArduinoToo) return true;
  const auto chip = chip_by_id(vendor, product);
  if (chip == SerialChip::kFtdi) return product == 0x6001 || product == 0x6015;
  return chip.has_value();
}

std::string udev_rule(std::uint16_t vendor, std::uint16_t product) {
  return fmt::format(
      R"(SUBSYSTEM=="usb", ENV{{DEVTYPE}}=="usb_device", ATTR{{idVendor}}=="{:04x}", ATTR{{idProduct}}=="{:04x}", )"
      R"(ENV{{ID_MM_DEVICE_IGNORE}}="1", MODE="0660", GROUP="plugdev", TAG+="uaccess")",
      vendor, product);
}

}  // namespace vitrine::acquisition
