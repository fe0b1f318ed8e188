// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/usb_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include "acquisition/device/udev_rule.h"

namespace vitrine::acquisition {
namespace {

class DeviceList {
 public:
  explicit DeviceList(libusb_context* context) {
    count_ = libusb_get_device_list(context, &devices_);
  }
  ~DeviceList() {
    if (count_ >= 0) libusb_free_device_list(devices_, 1);
  }
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;

  std::span<libusb_device*> devices() const {
    return {devices_, count_ > 0 ? static_cast<std::size_t>(count_) : 0};
  }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t count_ = 0;
};

// Returns the port of a device, such as "1-2.4": the bus, then the hub ports on the path.
std::string port_of(libusb_device* device) {
  std::array<std::uint8_t, 7> sockets{};
  const int count = libusb_get_port_numbers(device, sockets.data(), sockets.size());
  std::string port = std::to_string(libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i)
    port += fmt::format("{}{}", i == 0 ? '-' : '.', sockets[i]);
  return port;
}

bool may_be(libusb_device* device, const BoardSelector& selector) {
  libusb_device_descriptor descriptor{};
  return libusb_get_device_descriptor(device, &descriptor) == LIBUSB_SUCCESS &&
         descriptor.idVendor == selector.vendor && descriptor.idProduct == selector.product &&
         (selector.port.empty() || selector.port == port_of(device));
}

std::string serial_of(libusb_device_handle* handle) {
  libusb_device_descriptor descriptor{};
  if (libusb_get_device_descriptor(libusb_get_device(handle), &descriptor) != LIBUSB_SUCCESS ||
      descriptor.iSerialNumber == 0)
    return {};
  std::array<unsigned char, 128> text{};
  const int length = libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber,
                                                        text.data(), text.size());
  return length > 0 ? std::string(text.begin(), text.begin() + length) : std::string();
}

Expected<UsbDevice> open_one(libusb_device* device, const BoardSelector& selector) {
  libusb_device_handle* handle = nullptr;
  const int code = libusb_open(device, &handle);
  if (code == LIBUSB_ERROR_ACCESS) return tl::unexpected(no_access(selector));
  if (code != LIBUSB_SUCCESS)
    return tl::unexpected(usb_error(usb_name(selector), "cannot be opened", code));
  UsbHandle owned(handle);
  return UsbDevice{
      .handle = std::move(owned), .serial = serial_of(handle), .port = port_of(device)};
}

std::string wanted(const BoardSelector& selector) {
  return usb_name(selector) +
         (selector.serial.empty() ? "" : fmt::format(" with serial number {}", selector.serial)) +
         (selector.port.empty() ? "" : fmt::format(" in socket {}", selector.port));
}

class ConfigDescriptor {
 public:
  explicit ConfigDescriptor(libusb_device* device) {
    if (libusb_get_active_config_descriptor(device, &config_) != LIBUSB_SUCCESS) config_ = nullptr;
  }
  ~ConfigDescriptor() { libusb_free_config_descriptor(config_); }
  ConfigDescriptor(const ConfigDescriptor&) = delete;
  ConfigDescriptor& operator=(const ConfigDescriptor&) = delete;

  // Returns the first alternate setting of each interface.
  std::vector<const libusb_interface_descriptor*> interfaces() const {
    std::vector<const libusb_interface_descriptor*> all;
    for (int i = 0; config_ != nullptr && i < config_->bNumInterfaces; ++i)
      if (config_->interface[i].num_altsetting > 0)
        all.push_back(&config_->interface[i].altsetting[0]);
    return all;
  }

 private:
  libusb_config_descriptor* config_ = nullptr;
};

// Returns whether the interface has a bulk endpoint in each direction. Stores the endpoints in
// `line`.
bool take_endpoints(const libusb_interface_descriptor& interface, SerialEndpoints& line) {
  line.in = line.out = 0;
  for (int i = 0; i < interface.bNumEndpoints; ++i) {
    const libusb_endpoint_descriptor& endpoint = interface.endpoint[i];
    if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_BULK) continue;
    const bool in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
    (in ? line.in : line.out) = endpoint.bEndpointAddress;
    if (in) line.packet_size = endpoint.wMaxPacketSize & 0x7ff;
  }
  line.data_interface = interface.bInterfaceNumber;
  return line.in != 0 && line.out != 0 && line.packet_size != 0;
}

int cdc_control_interface(const ConfigDescriptor& config) {
  for (const auto* interface : config.interfaces())
    if (interface->bInterfaceClass == LIBUSB_CLASS_COMM && interface->bInterfaceSubClass == 2)
      return interface->bInterfaceNumber;
  return -1;
}

}  // namespace

Expected<UsbContext> open_usb() {
  libusb_context* context = nullptr;
  if (const int code = libusb_init(&context); code != LIBUSB_SUCCESS)
    return tl::unexpected(usb_error("USB", "cannot be used", code));
  return UsbContext(context);
}

std::string usb_name(const BoardSelector& selector) {
  return fmt::format("USB board {:04x}:{:04x}", selector.vendor, selector.product);
}

Error no_access(const BoardSelector& selector) {
  const std::string cause = usb_name(selector) + ": permission denied; ";
  if (has_udev_rule(selector.vendor, selector.product))
    return {ErrorCode::kIo, cause + "install deploy/60-vitrine.rules and plug the board in again"};
  return {ErrorCode::kIo,
          fmt::format("{}add this line to deploy/60-vitrine.rules, install that and plug the board "
                      "in again: {}",
                      cause, udev_rule(selector.vendor, selector.product))};
}

Error usb_error(const std::string& name, const char* doing, int code) {
  switch (code) {
    case LIBUSB_ERROR_NO_DEVICE:
    case LIBUSB_ERROR_NOT_FOUND:
      return {ErrorCode::kIo, name + " is gone; check its cable and power"};
    case LIBUSB_ERROR_BUSY:
      return {ErrorCode::kIo, name + " is in use; end the other program that uses the board"};
    default:
      return {ErrorCode::kIo, fmt::format("{} {} ({}); check its cable, or plug it in again", name,
                                          doing, libusb_error_name(code))};
  }
}

Expected<UsbDevice> choose(std::vector<Expected<UsbDevice>> candidates,
                           const BoardSelector& selector) {
  const auto is_meant = [&](const Expected<UsbDevice>& device) {
    return device && (selector.serial.empty() || selector.serial == device->serial);
  };
  const auto could_be = [&](const Expected<UsbDevice>& device) {
    return is_meant(device) || (!device && selector.serial.empty());
  };
  const auto count = std::ranges::count_if(candidates, could_be);
  if (count > 1)
    return fail(ErrorCode::kBadInput,
                fmt::format("{} devices match {}; select one by its serial number or port", count,
                            wanted(selector)));
  const auto found = std::ranges::find_if(candidates, is_meant);
  if (found != candidates.end()) return std::move(*found);
  const auto closed =
      std::ranges::find_if(candidates, [](const Expected<UsbDevice>& device) { return !device; });
  if (closed != candidates.end()) return std::move(*closed);
  return fail(ErrorCode::kIo, wanted(selector) + " is not there; check its cable and power");
}

Expected<UsbDevice> open_usb_device(libusb_context* context, const BoardSelector& selector) {
  const DeviceList list(context);
  std::vector<Expected<UsbDevice>> candidates;
  for (libusb_device* device : list.devices())
    if (may_be(device, selector)) candidates.push_back(open_one(device, selector));
  return choose(std::move(candidates), selector);
}

Expected<SerialEndpoints> find_serial_line(libusb_device* device, const BoardSelector& selector) {
  const ConfigDescriptor config(device);
  const auto chip = chip_by_id(selector.vendor, selector.product);
  SerialEndpoints line{.chip = chip.value_or(SerialChip::kCdcAcm)};
  if (!chip) line.control_interface = cdc_control_interface(config);
  if (chip || line.control_interface >= 0) {
    for (const auto* interface : config.interfaces())
      if (take_endpoints(*interface, line)) return line;
  }
  return fail(ErrorCode::kUnsupported,
              usb_name(selector) +
                  " has no supported serial interface (CDC-ACM, FTDI, CH34x); "
                  "check vendor and product");
}

}  // namespace vitrine::acquisition
