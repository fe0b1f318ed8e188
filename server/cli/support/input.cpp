// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/input.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "codec/files/file_descriptor.h"
#include "codec/format/signature.h"

namespace vitrine::server::cli {
namespace {

Unexpected unreadable(const std::string& path, int error) {
  const char* next = error == ENOENT ? "check its name" : "check its permissions";
  return fail(ErrorCode::kIo,
              fmt::format("cannot read {}: {}; {}", path, std::strerror(error), next));
}

}  // namespace

Expected<void> check_distinct(const std::string& path, const std::string& out) {
  std::error_code missing;  // set if a file is missing; it is then not the same file
  if (!std::filesystem::equivalent(path, out, missing)) return {};
  return fail(ErrorCode::kIo, out + " is the input itself; choose another name for the output");
}

Expected<InputFile> InputFile::open(const std::string& path) {
  // O_NONBLOCK: if the path is a named pipe, open() does not wait for a writer.
  const FileDescriptor fd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (!fd || ::fstat(fd.get(), &status) != 0) return unreadable(path, errno);
  if (!S_ISREG(status.st_mode)) {
    return fail(ErrorCode::kIo, path + " is not a file; give a mesh or .pmesh file");
  }
  if (status.st_size == 0) {
    return fail(ErrorCode::kBadInput, path + " is empty; export or download it again");
  }
  const auto size = static_cast<std::size_t>(status.st_size);
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd.get(), 0);
  if (data == MAP_FAILED) return unreadable(path, errno);
  return InputFile({static_cast<const std::uint8_t*>(data), size});
}

Expected<InputFile> InputFile::open_mesh(const std::string& path) {
  auto file = open(path);
  if (!file || !file->is_pmesh()) return file;
  return fail(ErrorCode::kBadInput,
              path + " is a .pmesh file, not a mesh; give the mesh that it was built from");
}

InputFile::InputFile(InputFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}

InputFile::~InputFile() {
  if (!bytes_.empty()) ::munmap(const_cast<std::uint8_t*>(bytes_.data()), bytes_.size());
}

bool InputFile::is_pmesh() const {
  return vitrine::is_pmesh(bytes_);
}

}  // namespace vitrine::server::cli
