// SPDX-License-Identifier: Apache-2.0
#include "acquisition/device/conversation.h"

namespace vitrine::acquisition {

Expected<void> Conversation::say(std::string_view line) {
  return port_.write(std::string(line) + '\n');
}

Expected<std::optional<std::string>> Conversation::hear(SerialPort::Clock::time_point deadline) {
  while (true) {
    if (SerialPort::Clock::now() >= deadline) return std::nullopt;
    if (auto line = reader_.next()) return line;
    const Expected<std::string> bytes = port_.read(deadline);
    if (!bytes) return tl::unexpected(bytes.error());
    if (bytes->empty()) return std::nullopt;
    reader_.feed(*bytes);
  }
}

Expected<void> Conversation::ignore_all(std::chrono::milliseconds quiet) {
  constexpr int kMostReads = 100;  // ends the loop if a board never stops sending
  for (int i = 0; i < kMostReads; ++i) {
    const Expected<std::string> bytes = port_.read(SerialPort::Clock::now() + quiet);
    if (!bytes) return tl::unexpected(bytes.error());
    if (bytes->empty()) break;
  }
  reader_.clear();
  return {};
}

}  // namespace vitrine::acquisition
