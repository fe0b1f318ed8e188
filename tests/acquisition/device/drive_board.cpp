// SPDX-License-Identifier: Apache-2.0
// drive_board VENDOR PRODUCT COMMAND…: opens a Horus board and executes commands: set:DEGREES,
// turn:DEGREES, laser:on, laser:off, where, unplugged (turns until the board is gone) and die
// (kills this process, like kill -9). Prints one line for each completed command.
#include <fmt/format.h>
#include <signal.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "acquisition/device/board.h"

namespace {

using vitrine::Expected;
using vitrine::acquisition::Board;

std::string name;

void say(const std::string& what) {
  fmt::print("{}: {}\n", name, what);
  std::fflush(stdout);
}

int failed(const std::string& message) {
  say("failed: " + message);
  return 1;
}

Expected<void> say_position(Board& board) {
  const auto at = board.position();
  if (!at) return vitrine::Unexpected(at.error());
  say(*at ? fmt::format("stands at {:.3f}", **at) : "stands anywhere");
  return {};
}

void wait_until_unplugged(Board& board) {
  say("waits to be unplugged");
  for (auto at = board.position();; at = board.position())
    if (!at) return say("ended: " + at.error().message);
}

Expected<void> obey(Board& board, const std::string& command) {
  const std::string verb = command.substr(0, command.find(':'));
  const std::string value = command.substr(std::min(command.size(), verb.size() + 1));
  if (verb == "set") return board.set_position(std::stod(value));
  if (verb == "turn") return board.turn_to(std::stod(value));
  if (verb == "laser") return board.laser(value == "on");
  if (verb == "where") return say_position(board);
  if (verb == "die") ::raise(SIGKILL);
  if (verb != "unplugged")
    return vitrine::fail(vitrine::ErrorCode::kBadInput, "unknown command " + verb);
  wait_until_unplugged(board);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  name = fmt::format("{}:{}", argv[1], argv[2]);
  const vitrine::acquisition::BoardSelector selector{
      .vendor = static_cast<std::uint16_t>(std::strtoul(argv[1], nullptr, 16)),
      .product = static_cast<std::uint16_t>(std::strtoul(argv[2], nullptr, 16))};
  auto board = vitrine::acquisition::open_board(selector);
  if (!board) return failed(board.error().message);
  say("opened " + (*board)->identity().firmware);
  for (int i = 3; i < argc; ++i) {
    if (const auto done = obey(**board, argv[i]); !done) return failed(done.error().message);
    say(argv[i]);
  }
  board->reset();
  say("closed");
  return 0;
}
