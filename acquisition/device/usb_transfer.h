// SPDX-License-Identifier: Apache-2.0
// Sends to a USB device while another thread handles libusb's events. libusb's synchronous calls
// are not used, because they free memory that the event thread may still use.
#pragma once

#include <libusb.h>

#include <cstdint>
#include <string_view>

#include "acquisition/device/serial_chip.h"

namespace vitrine::acquisition {

// Both functions return when the transfer is complete or, after one second, cancelled. They return
// LIBUSB_SUCCESS or libusb's error code.
int send_bulk(libusb_device_handle* device, std::uint8_t endpoint, std::string_view bytes);
int send_control(libusb_device_handle* device, const ControlRequest& request);

}  // namespace vitrine::acquisition
