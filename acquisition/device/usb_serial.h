// SPDX-License-Identifier: Apache-2.0
// A serial line over USB: CDC-ACM, FTDI or CH34x, through libusb.
#pragma once

#include <memory>

#include "acquisition/device/board.h"
#include "acquisition/device/serial_port.h"

namespace vitrine {

// Finds the device, takes it from the kernel's driver and sets the line up. DTR is raised and left
// up when the port is closed, so that a later opening is no edge to an Arduino. Errors as of
// open_board().
Expected<std::unique_ptr<SerialPort>> open_usb_serial(const BoardSelector& selector, int baud);

}  // namespace vitrine
