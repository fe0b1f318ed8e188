// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <map>

#include "codec/files/atomic_file.h"
#include "codec/files/read_file.h"
#include "server/backup/checksums.h"
#include "server/backup/tar.h"
#include "server/catalogue/snapshot.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/store/file_store.h"
#include "server/store/installation.h"

namespace vitrine::server {
namespace {

namespace fs = std::filesystem;

// The archive that is being written, the checksums of its files and the report.
class Archive {
 public:
  explicit Archive(TarWriter tar) : tar_(std::move(tar)) {}

  Expected<void> add(const std::string& name, std::span<const std::uint8_t> bytes) {
    sums_[name] = sha256(bytes);
    report.files += 1;
    report.bytes += bytes.size();
    return tar_.add(name, bytes);
  }
  Expected<void> finish() {
    const std::string text = to_text(sums_);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(text.data());
    if (auto added = tar_.add(std::string(kChecksums), {bytes, text.size()}); !added) return added;
    return tar_.finish();
  }

  BackupReport report;

 private:
  TarWriter tar_;
  Checksums sums_;
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

// Objects open for reading. They stay readable even if the store removes them, so the store's lock
// is needed only while they are opened.
using Objects = std::map<Sha256, std::unique_ptr<Object>>;

void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

Expected<void> open_object(const ObjectStore& store, const NamedFile& named, Objects& objects) {
  if (objects.contains(named.file)) return {};
  auto object = store.open(named.file);
  if (!object) return tl::unexpected(object.error());
  if (*object == nullptr) {
    return fail(ErrorCode::kState, fmt::format("the file of model {} is missing; publish it again",
                                               named.model.to_string()));
  }
  objects.emplace(named.file, std::move(*object));
  return {};
}

Expected<Objects> open_objects(const ObjectStore& store, const fs::path& snapshot,
                               BackupReport& report) {
  const auto catalogue = open_sqlite_catalogue(snapshot);
  if (!catalogue) return tl::unexpected(catalogue.error());
  const auto files = (*catalogue)->files();
  if (!files) return tl::unexpected(files.error());
  Objects objects;
  for (const NamedFile& file : *files) {
    if (auto opened = open_object(store, file, objects); !opened)
      return tl::unexpected(opened.error());
  }
  report.models = models_in(*files);
  return objects;
}

// Copies the catalogue to `snapshot` and opens the objects that it names, all as of one moment.
Expected<Objects> freeze(const fs::path& data, const fs::path& snapshot, BackupReport& report) {
  auto store = FileStore::open(data / "objects");
  if (!store) return tl::unexpected(store.error());
  const auto lock = store->lock();
  if (!lock) return tl::unexpected(lock.error());
  if (auto copied = snapshot_sqlite(data / kCatalogueFile, snapshot); !copied)
    return tl::unexpected(copied.error());
  return open_objects(*store, snapshot, report);
}

Expected<void> add_object(Archive& archive, const Sha256& name, const Object& object) {
  const auto bytes = object.read(0, object.size());
  if (!bytes) return tl::unexpected(bytes.error());
  const std::string hex = to_hex(name);
  if (sha256(*bytes) != name) {
    return fail(ErrorCode::kState,
                fmt::format("object {} is damaged; publish its model again", hex));
  }
  return archive.add(fmt::format("objects/{}/{}/{}", hex.substr(0, 2), hex.substr(2, 2), hex),
                     *bytes);
}

// Adds the files of all scans. Leaves out files whose names begin with a dot, which are still being
// written.
Expected<void> add_scans(Archive& archive, const fs::path& data) {
  std::error_code error;
  fs::recursive_directory_iterator at(data / "scans", error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    const bool is_file = fs::is_regular_file(at->symlink_status());
    if (!is_file || at->path().filename().string().starts_with('.')) continue;
    const auto bytes = read_file(at->path(), TarReader::kMaxFile);
    if (!bytes && !fs::exists(at->path())) continue;  // skips a file that was removed meanwhile
    if (!bytes) return tl::unexpected(bytes.error());
    const std::string name = at->path().lexically_relative(data).generic_string();
    if (auto added = archive.add(name, *bytes); !added) return added;
  }
  if (!error || error == std::errc::no_such_file_or_directory) return {};
  return fail(ErrorCode::kIo, fmt::format("cannot read {}: {}; check the data folder",
                                          (data / "scans").string(), error.message()));
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
  for (const auto& [name, object] : *objects) {
    if (auto added = add_object(archive, name, *object); !added)
      return tl::unexpected(added.error());
  }
  if (auto added = add_scans(archive, data); !added) return tl::unexpected(added.error());
  const auto catalogue = read_file(snapshot.file, TarReader::kMaxFile);
  if (!catalogue) return tl::unexpected(catalogue.error());
  if (auto added = archive.add(kCatalogueFile, *catalogue); !added)
    return tl::unexpected(added.error());
  if (auto finished = archive.finish(); !finished) return tl::unexpected(finished.error());
  return archive.report;
}

}  // namespace vitrine::server
