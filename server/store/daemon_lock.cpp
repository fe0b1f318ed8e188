// SPDX-License-Identifier: Apache-2.0
#include "server/store/daemon_lock.h"

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "codec/core/sha256.h"
#include "codec/files/read_file.h"
#include "server/catalogue/id.h"
#include "server/store/installation.h"

namespace vitrine::server {
namespace {

// Returns a hash of the file's inode and the machine's ID. A copy of the file gives another hash,
// since it has another inode or is on another machine.
std::string whereabouts(const FileDescriptor& file) {
  struct stat status {};
  ::fstat(file.get(), &status);
  const auto machine =
      codec::read_file("/etc/machine-id", 64);  // a container may have no machine ID
  std::string place = fmt::format("{} ", status.st_ino);
  if (machine) place.append(machine->begin(), machine->end());
  return to_hex(sha256({reinterpret_cast<const std::uint8_t*>(place.data()), place.size()}));
}

// Returns the file's content: the daemon's ID, and the result of whereabouts() when the file was
// written. The second text is empty in files of earlier versions. Returns nullopt if the file has
// no valid ID.
std::optional<std::pair<std::string, std::string>> kept_in(const FileDescriptor& file) {
  char text[128] = {};
  const ssize_t length = ::pread(file.get(), text, sizeof text - 1, 0);
  const std::string_view all(text, static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
  const auto id = all.substr(0, all.find(' '));
  if (!parse_ulid(id)) return std::nullopt;
  return std::pair(std::string(id), std::string(all.substr(std::min(id.size() + 1, all.size()))));
}

Expected<void> keep(const FileDescriptor& file, const std::string& text) {
  const ssize_t written = ::pwrite(file.get(), text.data(), text.size(), 0);
  if (written == static_cast<ssize_t>(text.size()) &&
      ::ftruncate(file.get(), static_cast<off_t>(text.size())) == 0 && ::fsync(file.get()) == 0) {
    return {};
  }
  return fail(ErrorCode::kIo, std::strerror(errno));
}

// Returns 0, or the error of the last attempt.
int try_to_lock(const FileDescriptor& file, const std::function<void()>& pause) {
  constexpr int kAttempts = 200;
  for (int attempt = 1;; ++attempt) {
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) return 0;
    if (errno != EWOULDBLOCK || attempt == kAttempts) return errno;
    pause();
  }
}

}  // namespace

void pause_for_lock() {
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

Expected<DataFolderLock> lock_data_folder(const std::filesystem::path& folder,
                                          const std::function<void()>& pause) {
  const std::filesystem::path path = folder / kDaemonLock;
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  const auto refused = [&](const std::string& why) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot lock {}: {}; check the data folder", path.string(), why));
  };
  if (!file) return refused(std::strerror(errno));
  if (const int fault = try_to_lock(file, pause); fault != 0) {
    if (fault != EWOULDBLOCK) return refused(std::strerror(fault));
    return fail(ErrorCode::kState,
                fmt::format("another daemon uses the data folder {}; stop it, or "
                            "give this one a folder of its own",
                            folder.string()));
  }
  const auto kept = kept_in(file);
  const std::string place = whereabouts(file);
  if (kept && kept->second == place) return DataFolderLock{std::move(file), kept->first};
  // A file with an ID but no result of whereabouts() was written by an earlier version. It does not
  // count as a copy.
  const bool is_copy = kept && !kept->second.empty();
  const std::string id = kept && !is_copy ? kept->first : to_string(generate_ulid());
  if (auto written = keep(file, id + ' ' + place); !written)
    return refused(written.error().message);
  return DataFolderLock{std::move(file), id, is_copy};
}

}  // namespace vitrine::server
