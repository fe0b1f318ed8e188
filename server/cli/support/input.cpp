// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/input.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "codec/files/file_descriptor.h"
#include "codec/format/signature.h"

namespace vitrine::server::cli {
namespace {

Unexpected unreadable(const std::string& path, int error) {
  const char* next = error == ENOENT ? "check its name" : "check its permissions";
  return fail(ErrorCode::kIo,
              fmt::format("cannot read {}: {}; {}", path, std::strerror(error), next));
}

constexpr std::uint64_t kMostOfStream = 4ull << 30;  // limit for standard input, in bytes

// Copies standard input into the file `to`. Returns 0, or an errno value: EFBIG if standard input
// has more than kMostOfStream bytes.
int copy_standard_input(int to) {
  std::vector<std::uint8_t> block(1 << 20);
  for (std::uint64_t copied = 0;;) {
    const ssize_t n = ::read(STDIN_FILENO, block.data(), block.size());
    if (n == 0) return 0;
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    const auto size = static_cast<std::size_t>(n);
    if ((copied += size) > kMostOfStream) return EFBIG;
    // A write to a memory file either fails or is complete.
    if (::write(to, block.data(), size) != n) return errno;
  }
}

// Returns a memory file that holds all of standard input.
Expected<FileDescriptor> read_standard_input() {
  FileDescriptor file(::memfd_create("standard input", MFD_CLOEXEC));
  const int error = file ? copy_standard_input(file.get()) : errno;
  if (error == 0) return file;
  if (error == EFBIG) {
    return fail(ErrorCode::kLimit,
                fmt::format("standard input has more than {} GiB; give the name of a file",
                            kMostOfStream >> 30));
  }
  return fail(ErrorCode::kIo, fmt::format("cannot read standard input: {}; give the name of a file",
                                          std::strerror(error)));
}

}  // namespace

std::string input_name(const std::string& path) {
  return path == kStandardStream ? "standard input" : path;
}

Expected<void> check_distinct(const std::string& path, const std::string& out) {
  if (path == kStandardStream || out == kStandardStream) return {};
  std::error_code missing;  // set if a file is missing; the files then differ
  if (!std::filesystem::equivalent(path, out, missing)) return {};
  return fail(ErrorCode::kIo, out + " is the input itself; choose another name for the output");
}

Expected<InputFile> InputFile::open(const std::string& path) {
  if (path == kStandardStream) {
    const auto file = read_standard_input();
    if (!file) return tl::unexpected(file.error());
    return map(file->get(), input_name(path));
  }
  // O_NONBLOCK keeps open() from waiting for a writer if the path is a named pipe.
  const FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!fd) return unreadable(path, errno);
  return map(fd.get(), path);
}

Expected<InputFile> InputFile::map(int fd, const std::string& name) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) return unreadable(name, errno);
  if (!S_ISREG(status.st_mode)) {
    return fail(ErrorCode::kIo, name + " is not a file; give a mesh or .pmesh file");
  }
  if (status.st_size == 0) {
    return fail(ErrorCode::kBadInput, name + " is empty; export or download it again");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd, 0);
  if (data == MAP_FAILED) return unreadable(name, errno);
  return InputFile({static_cast<const std::uint8_t*>(data), size});
}

Expected<InputFile> InputFile::open_mesh(const std::string& path) {
  auto file = open(path);
  if (!file || !file->is_pmesh()) return file;
  return fail(
      ErrorCode::kBadInput,
      input_name(path) + " is a .pmesh file, not a mesh; give the mesh that it was built from");
}

InputFile::InputFile(InputFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

InputFile::~InputFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

bool InputFile::is_pmesh() const {
  return vitrine::is_pmesh(bytes_);
}

}  // namespace vitrine::server::cli
