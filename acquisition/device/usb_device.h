// SPDX-License-Identifier: Apache-2.0
// Finding and owning one USB device.
#pragma once

#include <libusb.h>

#include <memory>
#include <string>
#include <vector>

#include "acquisition/device/board.h"
#include "acquisition/device/serial_chip.h"

namespace vitrine {

struct UsbContextDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextDeleter>;

struct UsbHandleDeleter {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using UsbHandle = std::unique_ptr<libusb_device_handle, UsbHandleDeleter>;

Expected<UsbContext> open_usb();

// "USB board 2341:0043".
std::string usb_name(const BoardSelector& selector);
// That this user may not open it, and what lets them.
Error no_access(const BoardSelector& selector);
// Any other fault in words with the next step.
Error usb_error(const std::string& name, const char* doing, int code);

struct UsbDevice {
  UsbHandle handle;
  std::string serial;  // empty where it has none
  std::string port;    // as of BoardSelector
};

// The device that `selector` means, of all with its numbers and port. One that could not be opened
// has a serial number that nobody knows; where the one meant is not among the others, it is the
// fault.
Expected<UsbDevice> choose(std::vector<Expected<UsbDevice>> candidates,
                           const BoardSelector& selector);
Expected<UsbDevice> open_usb_device(libusb_context* context, const BoardSelector& selector);

// Where a device's serial line is.
struct SerialEndpoints {
  SerialChip chip = SerialChip::kCdcAcm;
  int control_interface = -1, data_interface = 0;  // the former for CDC-ACM only
  std::uint8_t in = 0, out = 0;
  std::size_t packet_size = 0;  // of `in`, never 0
};
Expected<SerialEndpoints> find_serial_line(libusb_device* device, const BoardSelector& selector);

}  // namespace vitrine
