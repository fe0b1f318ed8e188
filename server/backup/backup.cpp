// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <string_view>
#include <vector>

#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"
#include "server/backup/checksums.h"
#include "server/backup/tar.h"
#include "server/catalogue/find_faults.h"
#include "server/catalogue/snapshot.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/file_store.h"
#include "server/store/installation.h"
#include "server/store/scrub.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

// The archive that is being written, the checksums of its files, and the report.
class Archive {
 public:
  explicit Archive(TarWriter tar) : tar_(std::move(tar)) {}

  Expected<void> add(const std::string& name, std::span<const std::uint8_t> bytes) {
    sums_[name] = sha256(bytes);
    report.files += 1;
    report.bytes += bytes.size();
    return tar_.add(name, bytes);
  }
  Expected<void> add(const std::string& name, const std::string& text) {
    return add(name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  // Records that the installation has lost an object. `state` is "damaged" or "missing".
  void note_loss(const NamedFile& object, std::string_view state) {
    lost_[object_path(object.file)] = object.file;
    report.damaged.push_back(fmt::format("{} of model {} is {}", object_path(object.file),
                                         object.model.to_string(), state));
  }
  Expected<void> finish() {
    if (!lost_.empty()) {
      if (auto added = add(std::string(kDamagedList), to_text(lost_)); !added) return added;
    }
    const std::string text = to_text(sums_);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    if (auto added = tar_.add(std::string(kChecksums), {bytes, text.size()}); !added) return added;
    return tar_.finish();
  }

  BackupReport report;

 private:
  TarWriter tar_;
  Checksums sums_, lost_;
};

// A temporary copy of the catalogue. The destructor removes the copy and SQLite's files beside it.
struct Snapshot {
  explicit Snapshot(fs::path path) : file(std::move(path)) {}
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;
  ~Snapshot() {
    for (const char* suffix : {"", "-wal", "-shm", "-journal"})
      ::unlink((file.string() + suffix).c_str());
  }
  const fs::path file;
};

struct OpenObject {
  NamedFile file;
  Expected<std::unique_ptr<Object>> object;  // null if it is missing, an error if it is damaged
};

// Objects open for reading. They stay readable even if the store removes them, so the store's lock
// is needed only while they are opened.
using Objects = std::vector<OpenObject>;

void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

Expected<Objects> open_objects(const FileStore& store, const fs::path& snapshot,
                               BackupReport& report) {
  const auto catalogue = open_sqlite_catalogue(snapshot);
  if (!catalogue) return tl::unexpected(catalogue.error());
  const auto all = (*catalogue)->files();
  if (!all) return tl::unexpected(all.error());
  report.models = models_in(*all);
  const auto files = distinct_files(**catalogue);
  if (!files) return tl::unexpected(files.error());
  Objects objects;
  for (const NamedFile& file : *files) {
    auto object = store.open_unchecked(file.file);
    if (!object && object.error().code != ErrorCode::kState) return tl::unexpected(object.error());
    objects.push_back({file, std::move(object)});
  }
  return objects;
}

// Copies the catalogue to `snapshot`, and opens the objects that the copy names. Holds the store's
// lock during both steps, so that no object is removed.
Expected<Objects> freeze(const fs::path& data, const fs::path& snapshot, BackupReport& report) {
  auto store = FileStore::open(data / "objects");
  if (!store) return tl::unexpected(store.error());
  const auto lock = store->lock();
  if (!lock) return tl::unexpected(lock.error());
  if (auto copied = snapshot_sqlite(data / kCatalogueFile, snapshot); !copied)
    return tl::unexpected(copied.error());
  return open_objects(*store, snapshot, report);
}

// Adds an object to the archive. If the object is missing, unreadable or does not have its hash,
// records the loss instead.
Expected<void> add_object(Archive& archive, const OpenObject& open) {
  if (open.object && *open.object == nullptr) {
    archive.note_loss(open.file, "missing");
    return {};
  }
  const auto bytes =
      open.object.and_then([](const auto& object) { return object->read(0, object->size()); });
  if (!bytes || sha256(*bytes) != open.file.file) {
    archive.note_loss(open.file, "damaged");
    return {};
  }
  return archive.add(object_path(open.file.file), *bytes);
}

// Adds a file of a scan. Skips a file that was removed during the backup.
Expected<void> add_scan_file(Archive& archive, const fs::path& data, const fs::path& file) {
  const auto bytes = read_file(file, TarReader::kMaxFile);
  const std::string name = file.lexically_relative(data).generic_string();
  if (bytes) return archive.add(name, *bytes);
  std::error_code unknown;
  if (fs::symlink_status(file, unknown).type() != fs::file_type::not_found)
    archive.report.damaged.push_back(fmt::format("{} cannot be read", name));
  return {};
}

// Adds the files in a folder of scans and its subfolders. Lists files and folders in the report
// that cannot be read. Skips files and folders whose names begin with a dot, because these are
// being written or deleted.
Expected<void> add_scans(Archive& archive, const fs::path& data, const fs::path& folder) {
  std::error_code error, unknown;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    if (at->path().filename().string().starts_with('.')) continue;
    const fs::file_type type = at->symlink_status(unknown).type();
    const bool may_be_file = type == fs::file_type::regular || type == fs::file_type::none;
    Expected<void> added;
    if (type == fs::file_type::directory) added = add_scans(archive, data, at->path());
    if (may_be_file) added = add_scan_file(archive, data, at->path());
    if (!added) return added;
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    archive.report.damaged.push_back(
        fmt::format("{} cannot be read", folder.lexically_relative(data).generic_string()));
  }
  return {};
}

}  // namespace

Expected<BackupReport> back_up(const fs::path& data, const fs::path& file) {
  auto tar = TarWriter::create(file);
  if (!tar) return tl::unexpected(tar.error());
  allow_many_files();
  Archive archive(std::move(*tar));
  const Snapshot snapshot(folder_of(file) / fmt::format(".catalogue.{}.part", ::getpid()));
  const auto objects = freeze(data, snapshot.file, archive.report);
  if (!objects) return tl::unexpected(objects.error());
  for (const OpenObject& object : *objects) {
    if (auto added = add_object(archive, object); !added) return tl::unexpected(added.error());
  }
  if (auto added = add_scans(archive, data, data / "scans"); !added)
    return tl::unexpected(added.error());
  const auto faults = sqlite::find_faults(snapshot.file);
  if (!faults) return tl::unexpected(faults.error());
  for (const std::string& fault : *faults)
    archive.report.damaged.push_back(fmt::format("{}: {}", kCatalogueFile, fault));
  const auto catalogue = read_file(snapshot.file, TarReader::kMaxFile);
  if (!catalogue) return tl::unexpected(catalogue.error());
  if (auto added = archive.add(kCatalogueFile, *catalogue); !added)
    return tl::unexpected(added.error());
  if (auto finished = archive.finish(); !finished) return tl::unexpected(finished.error());
  return archive.report;
}

}  // namespace vitrine::server
