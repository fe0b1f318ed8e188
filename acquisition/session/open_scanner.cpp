// SPDX-License-Identifier: Apache-2.0
#include "acquisition/session/open_scanner.h"

namespace vitrine::acquisition {

Scanner open_scanner(const ScannerConfig& config) {
  Scanner scanner;
  scanner.name = config.name;
  scanner.settings = config.settings;
  scanner.calibrations = config.calibrations;
  scanner.devices.open_camera = [camera = config.camera] { return open_camera(camera); };
  scanner.devices.open_board = [board = config.board, power = scanner.power] {
    return open_board(board, {.power = power});
  };
  return scanner;
}

}  // namespace vitrine::acquisition
