// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "codec/files/atomic_file.h"
#include "server/backup/backup.h"
#include "server/backup/checksums.h"
#include "server/backup/tar.h"
#include "server/catalogue/private_file.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/disk_space.h"
#include "server/store/file_store.h"
#include "server/store/installation.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kObjects = "objects/", kScans = "scans/";

// Succeeds if the folder does not exist, or is empty except for "lost+found".
Expected<void> check_empty(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator at(folder, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    if (at->path().filename() == "lost+found") continue;
    return fail(ErrorCode::kIo,
                fmt::format("{} is not empty; restore into a new folder", folder.string()));
  }
  if (!error || error == std::errc::no_such_file_or_directory) return {};
  return fail(ErrorCode::kIo, fmt::format("cannot open {}: {}; choose another folder",
                                          folder.string(), error.message()));
}

// Whether `path` is relative, and no part of it is empty or starts with a dot. Such a path cannot
// lead out of its folder.
bool is_plain_path(std::string_view path) {
  constexpr std::size_t kLongest = 1024;
  if (path.empty() || path.size() > kLongest || path.ends_with('/')) return false;
  while (!path.empty()) {
    const std::string_view part = path.substr(0, path.find('/'));
    if (part.empty() || part.starts_with('.') || part.find('\0') != part.npos) return false;
    path.remove_prefix(std::min(path.size(), part.size() + 1));
  }
  return true;
}

class Restoration {
 public:
  Restoration(fs::path file, fs::path data) : file_(std::move(file)), data_(std::move(data)) {}

  Expected<BackupReport> run() {
    // The error is ignored, because unpack() also fails if the folder could not be created.
    std::error_code error;
    const bool made = create_private_folder(data_, error);
    auto done = unpack();
    if (!done) take_back(made);
    return done;
  }

 private:
  Unexpected damaged(std::string_view name, std::string_view why) const {
    return fail(ErrorCode::kBadInput,
                fmt::format("{}: {} {}; take another backup", file_.string(), name, why));
  }

  // Checks that the disk has room for all of the backup. Ignores errors, because opening the file
  // then fails as well.
  Expected<void> check_room() const {
    std::error_code error;
    const std::uint64_t bytes = fs::file_size(file_, error);
    return error ? Expected<void>() : check_free(data_, bytes);
  }

  Expected<BackupReport> unpack() {
    if (auto fits = check_room(); !fits) return tl::unexpected(fits.error());
    auto store = FileStore::open(data_ / "objects");
    if (!store) return tl::unexpected(store.error());
    auto tar = TarReader::open(file_);
    if (!tar) return tl::unexpected(tar.error());
    for (;;) {
      auto entry = tar->next();
      if (!entry) return tl::unexpected(entry.error());
      if (!*entry) break;
      if (auto taken = take(**entry, *store); !taken) return tl::unexpected(taken.error());
    }
    if (auto same = compare(); !same) return tl::unexpected(same.error());
    if (auto whole = check_models(*store); !whole) return tl::unexpected(whole.error());
    std::error_code error;
    fs::rename(unnamed(), data_ / kCatalogueFile, error);
    if (error) return damaged(kCatalogueFile, "cannot be put in place: " + error.message());
    if (auto synced = sync_folder(data_); !synced) return tl::unexpected(synced.error());
    return report_;
  }

  Expected<void> take(TarEntry& entry, ObjectStore& store) {
    if (entry.name == kChecksums) {
      stated_ = parse_checksums(entry.bytes);
      if (!stated_) return damaged(kChecksums, "is malformed");
      return {};
    }
    found_[entry.name] = sha256(entry.bytes);
    report_.files += 1;
    report_.bytes += entry.bytes.size();
    if (entry.name == kDamagedList) {
      lost_ = parse_checksums(entry.bytes);
      return lost_ ? Expected<void>() : damaged(kDamagedList, "is malformed");
    }
    if (entry.name == kCatalogueFile) return take_catalogue(entry);
    if (entry.name.starts_with(kObjects)) return take_object(entry, store);
    if (entry.name.starts_with(kScans) && is_plain_path(entry.name)) return take_scan(entry);
    return damaged(entry.name, "does not belong in a backup");
  }

  // The catalogue contains hashes of tokens, and drafts, so only the owner may read it.
  Expected<void> take_catalogue(const TarEntry& entry) {
    if (auto written = write_file_atomically(unnamed(), entry.bytes); !written) return written;
    std::error_code error;
    fs::permissions(unnamed(), fs::perms::owner_read | fs::perms::owner_write, error);
    return error ? damaged(kCatalogueFile, "cannot be protected: " + error.message())
                 : Expected<void>();
  }

  Expected<void> take_object(const TarEntry& entry, ObjectStore& store) {
    Sha256 name{};
    const std::size_t last = entry.name.rfind('/') + 1;
    if (!from_hex(std::string_view(entry.name).substr(last), name))
      return damaged(entry.name, "does not belong in a backup");
    if (found_[entry.name] != name) return damaged(entry.name, "is damaged");
    const auto put = store.put(name, entry.bytes);
    return put ? Expected<void>{} : tl::unexpected(put.error());
  }

  Expected<void> take_scan(const TarEntry& entry) {
    const fs::path path = data_ / entry.name;
    std::error_code error;
    // An error is ignored, because writing the file then fails as well.
    fs::create_directories(path.parent_path(), error);
    return write_file_atomically(path, entry.bytes);
  }

  Expected<void> compare() const {
    if (!stated_) return damaged(kChecksums, "is missing: the file is cut short");
    for (const auto& [name, hash] : *stated_) {
      const auto found = found_.find(name);
      if (found == found_.end()) return damaged(name, "is missing");
      if (found->second != hash) return damaged(name, "is damaged");
    }
    if (found_.size() != stated_->size()) return damaged(kChecksums, "does not name every file");
    if (!found_.contains(kCatalogueFile)) return damaged(kCatalogueFile, "is missing");
    return {};
  }

  // Checks that the store has every file that the catalogue names. Accepts that files are missing
  // if they were already lost when the backup was made.
  Expected<void> check_models(const ObjectStore& store) {
    const auto catalogue = open_sqlite_catalogue(unnamed());
    if (!catalogue) return tl::unexpected(catalogue.error());
    const auto files = (*catalogue)->files();
    if (!files) return tl::unexpected(files.error());
    for (const NamedFile& named : *files) {
      const auto size = store.size_of(named.file);
      if (!size) return tl::unexpected(size.error());
      if (*size) continue;
      const std::string path = object_path(named.file);
      if (!lost_ || !lost_->contains(path))
        return damaged("the file of model " + named.model.to_string(), "is missing");
      report_.damaged.push_back(
          fmt::format("{} of model {} was damaged", path, named.model.to_string()));
    }
    report_.models = models_in(*files);
    return {};
  }

  // Returns the temporary path of the catalogue. The catalogue gets its final name only after all
  // other files are restored.
  fs::path unnamed() const { return data_ / ".catalogue.restored"; }

  void take_back(bool folder_too) const {
    std::error_code ignored;
    for (const char* name : {"objects", "scans"})
      fs::remove_all(data_ / name, ignored);
    for (const char* suffix : {"", "-wal", "-shm"})
      fs::remove(unnamed().string() + suffix, ignored);
    if (folder_too) fs::remove(data_, ignored);
  }

  const fs::path file_, data_;
  BackupReport report_;
  Checksums found_;
  std::optional<Checksums> stated_;
  std::optional<Checksums> lost_;  // nullopt if the backup has all files
};

}  // namespace

Expected<BackupReport> restore(const fs::path& file, const fs::path& data) {
  if (auto empty = check_empty(data); !empty) return tl::unexpected(empty.error());
  return Restoration(file, data).run();
}

}  // namespace vitrine::server
