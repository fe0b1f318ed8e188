// SPDX-License-Identifier: Apache-2.0
#include "server/doctor/check_data.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "server/catalogue/snapshot.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/file_store.h"
#include "server/store/installation.h"

namespace vitrine {
namespace {

namespace fs = std::filesystem;

Finding check_permissions(const fs::path& data) {
  struct stat status {};
  if (::stat(data.c_str(), &status) != 0) {
    return {Verdict::kFail, "permissions",
            fmt::format("{}: {}", data.string(), std::strerror(errno)),
            "name the daemon's data folder"};
  }
  if (::access(data.c_str(), R_OK | W_OK | X_OK) != 0) {
    return {Verdict::kFail, "permissions",
            fmt::format("{} is not to be read and written by this user", data.string()),
            "run it as the daemon's user, or chown the folder to them"};
  }
  if ((status.st_mode & S_IRWXO) != 0) {
    return {Verdict::kWarn, "permissions", "every user of the machine may look into the folder",
            fmt::format("chmod o-rwx {}: drafts and hashes of tokens are in it", data.string())};
  }
  return {Verdict::kOk, "permissions", "read and written by this user, closed to others", ""};
}

Finding check_disk(const fs::path& data) {
  constexpr double kGigabyte = 1e9;
  struct statvfs disk {};
  if (::statvfs(data.c_str(), &disk) != 0)
    return {Verdict::kFail, "disk", std::strerror(errno), "check that it is mounted"};
  const double block = static_cast<double>(disk.f_frsize);
  const double free = static_cast<double>(disk.f_bavail) * block;
  const double all = static_cast<double>(disk.f_blocks) * block;
  const std::string detail =
      fmt::format("{:.1f} GB free of {:.1f} GB", free / kGigabyte, all / kGigabyte);
  const bool no_names = disk.f_files > 0 && disk.f_favail == 0;  // some file systems do not count
  if (free < 0.1 * kGigabyte || no_names)
    return {Verdict::kFail, "disk", detail, "free some space: nothing more can be published"};
  if (free < kGigabyte || free < 0.05 * all)
    return {Verdict::kWarn, "disk", detail, "free some space, or move the folder to a larger disk"};
  return {Verdict::kOk, "disk", detail, ""};
}

struct Files {
  std::size_t models = 0, missing = 0;
  std::string first;  // the id of a model whose file is not there, or not whole
};

Expected<Files> count_files(const fs::path& data, const fs::path& snapshot) {
  const auto catalogue = open_sqlite_catalogue(snapshot);
  if (!catalogue) return Unexpected(catalogue.error());
  const auto store = FileStore::open(data / "objects");
  if (!store) return Unexpected(store.error());
  const auto named = (*catalogue)->files();
  if (!named) return Unexpected(named.error());
  std::vector<NamedFile> missing;
  std::ranges::copy_if(*named, std::back_inserter(missing), [&](const NamedFile& file) {
    const auto object = store->open(file.file);
    return !object || *object == nullptr || (*object)->size() != file.bytes;
  });
  Files files{.models = models_in(*named), .missing = models_in(missing), .first = {}};
  if (!missing.empty()) files.first = missing.front().model.to_string();
  return files;
}

// In a copy: the catalogue of an older version would be migrated under its daemon.
Finding check_catalogue(const fs::path& data) {
  if (!fs::exists(data / kCatalogueFile)) {
    return {Verdict::kFail, "catalogue", "there is none in the folder",
            "name the data folder of a daemon, or start one with it"};
  }
  const fs::path copy = data / fmt::format(".doctor.{}", ::getpid());
  const auto copied = snapshot_sqlite(data / kCatalogueFile, copy);
  const auto files = copied ? count_files(data, copy) : Expected<Files>(Unexpected(copied.error()));
  for (const char* suffix : {"", "-wal", "-shm", "-journal"})
    ::unlink((copy.string() + suffix).c_str());
  if (!files) return {Verdict::kFail, "catalogue", files.error().message, "restore a backup"};
  if (files->missing > 0) {
    return {Verdict::kFail, "catalogue",
            fmt::format("{} of {} models have lost their file, {} first", files->missing,
                        files->models, files->first),
            "publish them again, or restore a backup"};
  }
  return {Verdict::kOk, "catalogue", fmt::format("{} models, their files are there", files->models),
          ""};
}

}  // namespace

Findings check_data(const fs::path& data) {
  Findings findings = {check_permissions(data)};
  if (findings.front().verdict == Verdict::kFail) return findings;
  findings.push_back(check_disk(data));
  findings.push_back(check_catalogue(data));
  return findings;
}

}  // namespace vitrine
