// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "server/cli/doctor/catalogue_copy.h"
#include "server/store/file_store.h"
#include "server/store/installation.h"

namespace vitrine::server {
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
            fmt::format("this user cannot read and write {}", data.string()),
            "run the doctor as the daemon's user, or chown the folder to that user"};
  }
  if ((status.st_mode & S_IRWXO) != 0) {
    return {Verdict::kWarn, "permissions", "every user of the machine can read the folder",
            fmt::format("run chmod o-rwx {}: it holds drafts and token hashes", data.string())};
  }
  return {Verdict::kOk, "permissions", "this user can read and write; others cannot", ""};
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
  // A total of 0 means that the file system does not count files.
  const bool no_names = disk.f_files > 0 && disk.f_favail == 0;
  if (free < 0.1 * kGigabyte || no_names)
    return {Verdict::kFail, "disk", detail, "free some space: no more models can be published"};
  if (free < kGigabyte || free < 0.05 * all)
    return {Verdict::kWarn, "disk", detail, "free some space, or move the folder to a larger disk"};
  return {Verdict::kOk, "disk", detail, ""};
}

struct FileCount {
  std::size_t models = 0, missing = 0;
  std::string first;  // ID of a model whose file is missing or incomplete
};

Expected<FileCount> count_files(const fs::path& data) {
  const CatalogueCopy copy(data);
  const auto catalogue = copy.open();
  if (!catalogue) return tl::unexpected(catalogue.error());
  const auto store = FileStore::open(data / "objects");
  if (!store) return tl::unexpected(store.error());
  const auto named = (*catalogue)->files();
  if (!named) return tl::unexpected(named.error());
  std::vector<NamedFile> missing;
  std::ranges::copy_if(*named, std::back_inserter(missing), [&](const NamedFile& file) {
    const auto size = store->size_of(file.file);
    return !size || *size != file.bytes;
  });
  FileCount files{.models = models_in(*named), .missing = models_in(missing), .first = {}};
  if (!missing.empty()) files.first = missing.front().model.to_string();
  return files;
}

Finding check_catalogue(const fs::path& data) {
  if (!fs::exists(data / kCatalogueFile)) {
    return {Verdict::kFail, "catalogue", "the folder has no catalogue",
            "name the data folder of a daemon, or start one with it"};
  }
  const auto files = count_files(data);
  if (!files) return {Verdict::kFail, "catalogue", files.error().message, "restore a backup"};
  if (files->missing > 0) {
    return {Verdict::kFail, "catalogue",
            fmt::format("the files of {} of {} models are missing, first of {}", files->missing,
                        files->models, files->first),
            "publish them again, or restore a backup"};
  }
  return {Verdict::kOk, "catalogue", fmt::format("{} models, all files present", files->models),
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

}  // namespace vitrine::server
