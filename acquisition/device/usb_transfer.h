// SPDX-License-Identifier: Apache-2.0
// Sending to a USB device while another thread handles libusb's events. libusb's own waiting calls
// are not for that: they free what the other thread may still be using.
#pragma once

#include <libusb.h>

#include <cstdint>
#include <string_view>

#include "acquisition/device/serial_chip.h"

namespace vitrine {

// Both return when the transfer is complete or has been cancelled after a second, with
// LIBUSB_SUCCESS or libusb's code of what went wrong.
int send_bulk(libusb_device_handle* device, std::uint8_t endpoint, std::string_view bytes);
int send_control(libusb_device_handle* device, const ControlRequest& request);

}  // namespace vitrine
