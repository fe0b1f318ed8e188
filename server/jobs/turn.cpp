// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/turn.h"

#include <fmt/format.h>

#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"

namespace vitrine {
namespace {

constexpr const char* kTurn = "turn";
constexpr std::uint64_t kMostBytes = 64;

}  // namespace

Expected<bool> holds_turn(const std::filesystem::path& folder, const std::string& turn) {
  std::error_code error;
  const bool is_there = std::filesystem::exists(folder, error);
  const bool is_named = !error && is_there && std::filesystem::exists(folder / kTurn, error);
  if (error) {
    return fail(ErrorCode::kIo, fmt::format("cannot look into the folder {}: {}", folder.string(),
                                            error.message()));
  }
  if (!is_named) return is_there && turn.empty();
  const auto bytes = read_file(folder / kTurn, kMostBytes);
  if (!bytes) return Unexpected(bytes.error());
  return turn == std::string(bytes->begin(), bytes->end());
}

Expected<void> begin_turn(const std::filesystem::path& folder, const std::string& turn) {
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  if (!error) std::filesystem::create_directory(folder, error);
  if (error) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot make the folder {} anew: {}; check its owner and mode",
                            folder.string(), error.message()));
  }
  return write_file_atomically(folder / kTurn,
                               {reinterpret_cast<const std::uint8_t*>(turn.data()), turn.size()});
}

}  // namespace vitrine
