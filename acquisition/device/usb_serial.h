// SPDX-License-Identifier: Apache-2.0
// A serial line over USB: CDC-ACM, FTDI or CH34x, through libusb.
#pragma once

#include <memory>

#include "acquisition/device/board.h"
#include "acquisition/device/serial_port.h"

namespace vitrine::acquisition {

// Finds the device, detaches the kernel's driver and configures the line. DTR is raised and stays
// raised after closing, so that an Arduino does not restart when it is opened again. Fails for the
// same reasons as open_board().
Expected<std::unique_ptr<SerialPort>> open_usb_serial(const BoardSelector& selector, int baud);

}  // namespace vitrine::acquisition
