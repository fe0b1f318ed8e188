// SPDX-License-Identifier: Apache-2.0
#include "server/store/local_copy.h"

#include <fmt/core.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "codec/files/atomic_file.h"
#include "server/store/file_object.h"

namespace vitrine::server {
namespace {

Error refused(int error) {
  return {ErrorCode::kIo, fmt::format("cannot keep a copy of an object: {}; {}",
                                      std::strerror(error), next_step(error))};
}

}  // namespace

Expected<LocalCopy> LocalCopy::create(const std::filesystem::path& folder) {
  std::string name = (folder / ".copy-XXXXXX").string();
  FileDescriptor file(::mkostemp(name.data(), O_CLOEXEC));
  if (!file) return tl::unexpected(refused(errno));
  ::unlink(name.c_str());
  return LocalCopy(std::move(file));
}

void LocalCopy::restart() {
  size_ = 0;
  if (::ftruncate(file_.get(), 0) != 0) fault_ = refused(errno);
}

bool LocalCopy::append(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(size_));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      fault_ = refused(n < 0 ? errno : ENOSPC);
      return false;
    }
    size_ += static_cast<std::uint64_t>(n);
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
  return true;
}

Expected<std::unique_ptr<Object>> LocalCopy::finish(const Sha256& name) && {
  if (size_ > 0) {
    void* const mapped = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file_.get(), 0);
    if (mapped == MAP_FAILED) return tl::unexpected(refused(errno));
    const bool is_it = sha256({static_cast<const std::uint8_t*>(mapped), size_}) == name;
    ::munmap(mapped, size_);
    if (!is_it) return nullptr;
  } else if (sha256({}) != name) {
    return nullptr;
  }
  return object_in(std::move(file_), size_);
}

}  // namespace vitrine::server
