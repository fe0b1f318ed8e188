// SPDX-License-Identifier: Apache-2.0
// Finds, opens and owns one USB device.
#pragma once

#include <libusb.h>

#include <memory>
#include <string>
#include <vector>

#include "acquisition/device/board.h"
#include "acquisition/device/serial_chip.h"

namespace vitrine::acquisition {

struct UsbContextDeleter {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextDeleter>;

struct UsbHandleDeleter {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using UsbHandle = std::unique_ptr<libusb_device_handle, UsbHandleDeleter>;

Expected<UsbContext> open_usb();

// Returns a name for messages, such as "USB board 2341:0043".
std::string usb_name(const BoardSelector& selector);
// Returns the error for a device that this user may not open, with the remedy.
Error no_access(const BoardSelector& selector);
// Returns the error for any failure of libusb other than missing permission, with the next step.
Error usb_error(const std::string& name, const char* doing, int code);

struct UsbDevice {
  UsbHandle handle;
  std::string serial;  // empty if the device has none
  std::string port;    // same format as in BoardSelector
};

// choose() returns the only candidate that matches `selector`. open_usb_device() makes the
// candidates from the connected devices and calls choose(). A device that cannot be opened is
// represented by its error, because its serial number cannot be read. If no other device matches,
// choose() returns that error.
Expected<UsbDevice> choose(std::vector<Expected<UsbDevice>> candidates,
                           const BoardSelector& selector);
Expected<UsbDevice> open_usb_device(libusb_context* context, const BoardSelector& selector);

// The USB interfaces and endpoints of a device's serial line.
struct SerialEndpoints {
  SerialChip chip = SerialChip::kCdcAcm;
  int control_interface = -1, data_interface = 0;  // control_interface is used by CDC-ACM only
  std::uint8_t in = 0, out = 0;
  std::size_t packet_size = 0;  // packet size of the endpoint `in`, never 0
};
Expected<SerialEndpoints> find_serial_line(libusb_device* device, const BoardSelector& selector);

}  // namespace vitrine::acquisition
