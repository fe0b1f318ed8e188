// SPDX-License-Identifier: Apache-2.0
// A temporary copy of the catalogue in a data folder. The doctor opens the copy, because opening
// the original would migrate its tables if an older daemon had created them.
#pragma once

#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>

#include "server/catalogue/snapshot.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/installation.h"

namespace vitrine::server {

class CatalogueCopy {
 public:
  explicit CatalogueCopy(const std::filesystem::path& data)
      : file_(data / fmt::format(".doctor.{}", ::getpid())),
        copied_(snapshot_sqlite(data / kCatalogueFile, file_)) {}
  CatalogueCopy(const CatalogueCopy&) = delete;
  CatalogueCopy& operator=(const CatalogueCopy&) = delete;
  ~CatalogueCopy() {
    for (const char* suffix : {"", "-wal", "-shm", "-journal"})
      ::unlink((file_.string() + suffix).c_str());
  }

  // Fails with kIo if the original cannot be read or is damaged.
  Expected<std::unique_ptr<Catalogue>> open() const {
    if (!copied_) return tl::unexpected(copied_.error());
    return open_sqlite_catalogue(file_);
  }

 private:
  const std::filesystem::path file_;
  const Expected<void> copied_;
};

}  // namespace vitrine::server
