// SPDX-License-Identifier: Apache-2.0
#include "server/log/log_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vitrine::server {
namespace {

Unexpected refused(const std::filesystem::path& file) {
  return fail(ErrorCode::kIo,
              fmt::format("cannot open the access log {}: {}; choose another with --access-log",
                          file.string(), std::strerror(errno)));
}

// Opens the log file and returns a descriptor that the caller must close. For standard error,
// returns a duplicate.
int open_file(const std::filesystem::path& file) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC;
  if (file == "-") return ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
  if (file.empty()) return ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  return ::open(file.c_str(), kFlags, 0640);
}

Expected<void> continue_in(const std::filesystem::path& file, int descriptor) {
  const int fresh = open_file(file);
  if (fresh < 0) return refused(file);
  const bool is_replaced = ::dup3(fresh, descriptor, O_CLOEXEC) >= 0;
  const auto result = is_replaced ? Expected<void>{} : refused(file);
  ::close(fresh);
  return result;
}

// Whether `file` is still a path of the open file whose status is `open`.
bool is_name_of(const std::filesystem::path& file, const struct stat& open) {
  struct stat named {};
  return ::stat(file.c_str(), &named) == 0 && named.st_dev == open.st_dev &&
         named.st_ino == open.st_ino;
}

}  // namespace

Expected<void> LogFile::open(int descriptor, const std::filesystem::path& file,
                             std::uint64_t max_bytes) {
  const std::scoped_lock lock(mutex_);
  if (auto opened = continue_in(file, descriptor); !opened) return opened;
  file_ = file;
  max_bytes_ = file == "-" ? 0 : max_bytes;
  return {};
}

void LogFile::replace_if_full(int descriptor) {
  const std::scoped_lock lock(mutex_);
  struct stat open {};
  if (max_bytes_ == 0 || ::fstat(descriptor, &open) != 0 || !S_ISREG(open.st_mode)) return;
  if (static_cast<std::uint64_t>(open.st_size) < max_bytes_) return;
  if (is_name_of(file_, open) && ::rename(file_.c_str(), (file_.string() + ".old").c_str()) != 0) {
    return;
  }
  static_cast<void>(continue_in(file_, descriptor));
}

}  // namespace vitrine::server
