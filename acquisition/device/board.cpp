// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/board.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "acquisition/device/fabscan.h"
#include "acquisition/device/guardian.h"
#include "acquisition/device/horus.h"
#include "acquisition/device/safe_board.h"
#include "acquisition/device/usb_serial.h"

namespace vitrine::acquisition {
namespace {

int baud_of(BoardDialect dialect) {
  return dialect == BoardDialect::kHorus ? horus::kBaud : fabscan::kBaud;
}

Expected<std::unique_ptr<Board>> open_guarded(const BoardSelector& selector,
                                              const BoardOptions& options) {
  auto opened = open_controller(selector, options.response_timeout);
  if (!opened) return tl::unexpected(opened.error());
  // Starts the guardian before anything is switched on. Sets the board's serial number and port in
  // the selector, so that the guardian finds exactly this board.
  BoardSelector this_one = selector;
  this_one.serial = opened->port->serial();
  this_one.port = opened->port->socket();
  auto guardian = Guardian::start(this_one, options.guardian);
  if (!guardian) return tl::unexpected(guardian.error());
  BoardIdentity identity{.dialect = name_of(selector.dialect), .serial = opened->port->serial()};
  return make_safe(std::move(*opened), std::move(identity), options, std::move(*guardian));
}

}  // namespace

Expected<BoardDialect> parse_board_dialect(const std::string& name) {
  if (name == "horus") return BoardDialect::kHorus;
  if (name == "fabscan") return BoardDialect::kFabScan;
  return fail(ErrorCode::kBadInput,
              fmt::format("unknown board dialect '{}'; use horus or fabscan", name));
}

const char* name_of(BoardDialect dialect) {
  return dialect == BoardDialect::kHorus ? "horus" : "fabscan";
}

Expected<OpenedController> open_controller(const BoardSelector& selector,
                                           std::chrono::milliseconds timeout) {
  auto port = open_usb_serial(selector, baud_of(selector.dialect));
  if (!port) return tl::unexpected(port.error());
  OpenedController opened{.port = std::move(*port), .controller = nullptr};
  opened.controller = selector.dialect == BoardDialect::kHorus
                          ? make_horus(*opened.port, timeout)
                          : make_fabscan(*opened.port, timeout, selector.steps_per_turn);
  return opened;
}

Expected<std::unique_ptr<Board>> open_board(const BoardSelector& selector,
                                            const BoardOptions& options) try {
  return open_guarded(selector, options);
  // An exception means, for example, that no thread could be started or that memory has run out.
} catch (const std::exception& error) {
  return fail(ErrorCode::kIo, fmt::format("{:04x}:{:04x} cannot be opened: {}; free memory and "
                                          "try again",
                                          selector.vendor, selector.product, error.what()));
}

}  // namespace vitrine::acquisition
