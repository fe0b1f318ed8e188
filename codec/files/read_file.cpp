// SPDX-License-Identifier: Apache-2.0
#include "codec/files/read_file.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstring>

#include "codec/files/atomic_file.h"
#include "codec/files/file_descriptor.h"

namespace vitrine::inline codec {
namespace {

Unexpected unreadable(const std::filesystem::path& path, int error) {
  const char* next = error == ENOENT ? "check the name" : next_step(error);
  return fail(ErrorCode::kIo,
              fmt::format("cannot read {}: {}; {}", path.string(), std::strerror(error), next));
}

}  // namespace

Expected<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path,
                                              std::uint64_t limit) {
  const FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) return unreadable(path, errno);
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint8_t> block(1 << 16);
  for (;;) {
    const ssize_t n = ::read(file.get(), block.data(), block.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return unreadable(path, errno);
    if (n == 0) return bytes;
    bytes.insert(bytes.end(), block.begin(), block.begin() + n);
    if (bytes.size() > limit) {
      return fail(ErrorCode::kLimit, fmt::format("{} is longer than {} bytes; name the right file",
                                                 path.string(), limit));
    }
  }
}

}  // namespace vitrine::inline codec
