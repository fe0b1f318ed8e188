// SPDX-License-Identifier: Apache-2.0
// Passes arbitrary bytes to the code that reads a motor board's output. This is the code for the
// packet format of each USB serial chip, and the parsers of Horus and FabScanPi answers.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "acquisition/device/fabscan.h"
#include "acquisition/device/horus.h"
#include "acquisition/device/line_reader.h"
#include "acquisition/device/serial_chip.h"

namespace {

using namespace vitrine;

using namespace vitrine::acquisition;

void check(bool holds) {
  if (!holds) std::abort();
}

void read_lines(std::string_view bytes, char prompt) {
  LineReader reader(prompt);
  reader.feed(bytes);
  for (std::size_t lines = 0; const auto line = reader.next(); ++lines) {
    check(lines < LineReader::kMostLines && line->size() <= LineReader::kLongest);
    const horus::Reply reply = horus::parse(*line);
    check(std::isfinite(reply.value) && reply.text.size() <= line->size());
    fabscan::is_version(*line);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto chip = static_cast<SerialChip>(data[0] % 3);
  const std::size_t packet_size = 1 + data[1];
  const std::span<const std::uint8_t> transfer(data + 2, size - 2);
  std::vector<std::uint8_t> payload;
  append_payload(chip, transfer, packet_size, payload);
  check(payload.size() <= transfer.size());
  const std::string_view bytes(reinterpret_cast<const char*>(payload.data()), payload.size());
  read_lines(bytes, '\n');
  read_lines(bytes, fabscan::kPrompt);
  return 0;
}
