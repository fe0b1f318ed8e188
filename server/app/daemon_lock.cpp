// SPDX-License-Identifier: Apache-2.0
#include "server/app/daemon_lock.h"

#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>
#include <cstring>

#include "server/catalogue/model_id.h"
#include "server/store/installation.h"

namespace vitrine {
namespace {

// What the file holds, or a new one that it holds from now on.
Expected<std::string> id_in(const FileDescriptor& file) {
  char text[64] = {};
  const ssize_t length = ::pread(file.get(), text, sizeof text - 1, 0);
  if (length > 0 && ModelId::parse({text, static_cast<std::size_t>(length)})) return text;
  const std::string fresh = ModelId::generate().to_string();
  const ssize_t written = ::pwrite(file.get(), fresh.data(), fresh.size(), 0);
  if (written == static_cast<ssize_t>(fresh.size()) &&
      ::ftruncate(file.get(), static_cast<off_t>(fresh.size())) == 0 && ::fsync(file.get()) == 0) {
    return fresh;
  }
  return fail(ErrorCode::kIo, std::strerror(errno));
}

}  // namespace

Expected<DataFolderLock> lock_data_folder(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / kDaemonLock;
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  const auto refused = [&](const std::string& why) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot lock {}: {}; check the data folder", path.string(), why));
  };
  if (!file) return refused(std::strerror(errno));
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return refused(std::strerror(errno));
    return fail(ErrorCode::kState,
                fmt::format("another daemon uses the data folder {}; stop it, or "
                            "give this one a folder of its own",
                            folder.string()));
  }
  auto id = id_in(file);
  if (!id) return refused(id.error().message);
  return DataFolderLock{std::move(file), std::move(*id)};
}

}  // namespace vitrine
