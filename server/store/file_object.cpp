// SPDX-License-Identifier: Apache-2.0
#include "server/store/file_object.h"

#include <fcntl.h>
#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vitrine::server {
namespace {

class FileObject final : public Object {
 public:
  FileObject(FileDescriptor fd, std::uint64_t size) : fd_(std::move(fd)), size_(size) {}

  std::uint64_t size() const override { return size_; }
  std::optional<int> descriptor() const override { return fd_.get(); }

  Expected<void> read(std::uint64_t offset, std::span<std::uint8_t> out) const override {
    if (offset > size_ || out.size() > size_ - offset) {
      return fail(ErrorCode::kIo, "read beyond the end of an object; check the data folder");
    }
    while (!out.empty()) {
      const ssize_t n = ::pread(fd_.get(), out.data(), out.size(), static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0)
        return fail(ErrorCode::kIo, fmt::format("cannot read an object: {}; check the data folder",
                                                n < 0 ? std::strerror(errno) : "cut short"));
      offset += static_cast<std::uint64_t>(n);
      out = out.subspan(static_cast<std::size_t>(n));
    }
    return {};
  }

 private:
  FileDescriptor fd_;
  std::uint64_t size_;
};

}  // namespace

std::unique_ptr<Object> object_in(FileDescriptor file, std::uint64_t size) {
  return std::make_unique<FileObject>(std::move(file), size);
}

bool is_intact(const Object& object, const Sha256& name, const OnPiece& on_piece) {
  std::vector<std::uint8_t> piece(std::min(kPieceBytes, object.size()));
  Sha256Hasher hasher;
  for (std::uint64_t at = 0; at < object.size(); at += piece.size()) {
    piece.resize(std::min(kPieceBytes, object.size() - at));
    if (!object.read(at, std::span(piece))) return false;
    hasher.add(piece);
    if (!on_piece(piece.size())) return false;
  }
  return hasher.finish() == name;
}

// Before reading each piece, asks the kernel to drop the cached copy of this piece. Does not drop
// the following pieces yet, because visitors may need them.
bool is_intact_on_disk(const Object& object, const Sha256& name, const OnPiece& on_piece) {
  std::uint64_t at = 0;
  const auto forget_next = [&](std::uint64_t length) {
    if (const auto file = object.descriptor()) {
      static_cast<void>(::posix_fadvise(*file, static_cast<off_t>(at), static_cast<off_t>(length),
                                        POSIX_FADV_DONTNEED));
    }
  };
  forget_next(kPieceBytes);
  return is_intact(object, name, [&](std::uint64_t length) {
    at += length;
    forget_next(length);
    return on_piece(length);
  });
}

}  // namespace vitrine::server
