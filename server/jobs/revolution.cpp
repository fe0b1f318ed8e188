// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/revolution.h"

#include <fmt/format.h>

#include <string_view>

#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"

namespace vitrine::server {
namespace {

constexpr const char* kFileName = "turn";
constexpr std::uint64_t kMostBytes = 64;
constexpr std::string_view kRemoved = ".removed-";  // prefix of folders that are being deleted

}  // namespace

Expected<bool> holds_revolution(const std::filesystem::path& folder,
                                const std::string& revolution) {
  std::error_code error;
  const bool is_there = std::filesystem::exists(folder, error);
  const bool is_named = !error && is_there && std::filesystem::exists(folder / kFileName, error);
  if (error) {
    return fail(ErrorCode::kIo, fmt::format("cannot look into the folder {}: {}", folder.string(),
                                            error.message()));
  }
  if (!is_named) return is_there && revolution.empty();
  const auto bytes = read_file(folder / kFileName, kMostBytes);
  if (!bytes) return tl::unexpected(bytes.error());
  return revolution == std::string(bytes->begin(), bytes->end());
}

Expected<void> begin_revolution(const std::filesystem::path& folder,
                                const std::string& revolution) {
  std::error_code error;
  std::filesystem::remove_all(folder, error);
  if (!error) std::filesystem::create_directory(folder, error);
  if (error) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot empty the folder {}: {}; check its owner and mode",
                            folder.string(), error.message()));
  }
  return write_file_atomically(
      folder / kFileName,
      {reinterpret_cast<const std::uint8_t*>(revolution.data()), revolution.size()});
}

Expected<void> remove_revolution(const std::filesystem::path& folder) {
  const auto removed = folder.parent_path() / (std::string(kRemoved) + folder.filename().string());
  std::error_code error;
  std::filesystem::rename(folder, removed, error);
  if (!error) {
    if (auto synced = sync_folder(folder.parent_path()); !synced) return synced;
    std::filesystem::remove_all(removed, error);
  }
  if (!error) return {};
  return fail(ErrorCode::kIo,
              fmt::format("cannot delete the folder {}: {}; check its owner and mode",
                          folder.string(), error.message()));
}

void sweep_removed_revolutions(const std::filesystem::path& scans) {
  std::error_code error;
  for (std::filesystem::directory_iterator at(scans, error), end; !error && at != end;
       at.increment(error)) {
    std::error_code ignored;
    if (at->path().filename().string().starts_with(kRemoved))
      std::filesystem::remove_all(at->path(), ignored);
  }
}

}  // namespace vitrine::server
