// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "server/backup/checksums.h"
#include "server/backup/tar.h"
#include "server/catalogue/snapshot.h"
#include "server/catalogue/sqlite.h"
#include "server/store/change.h"
#include "server/store/installation.h"
#include "support/process/run_program.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

std::string slurp(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

class BackupTest : public ::testing::Test {
 protected:
  ModelId publish(const std::string& title, ModelState state = ModelState::kPublished) {
    const auto done = server::publish(
        *installation.store, *installation.catalogue, tiny_pmesh("base of " + title, "chunk").bytes,
        {.title = title}, {.state = state, .repairs = "1 face dropped"});
    if (!done) throw std::runtime_error(done.error().message);
    return done->id;
  }
  // Publishes a model, but only its coarsest level. Returns the model's ID.
  ModelId publish_capped(const std::string& title) {
    ModelRecord model = installation.catalogue->find(publish(title)).value().value();
    model.public_part = PublicPart{.max_level = 0};
    const auto done = change(*installation.store, *installation.catalogue, model);
    if (!done) throw std::runtime_error(done.error().message);
    return done->id;
  }
  fs::path path(const std::string& name) const { return folder.path() / name; }

  // Tries to restore the backup. Expects that this fails and leaves no files behind. Returns the
  // error.
  std::string fault_of_restoring(const fs::path& backup) const {
    const auto done = restore(backup, path("again"));
    EXPECT_FALSE(done);
    EXPECT_FALSE(fs::exists(path("again")));
    return done ? "" : done.error().message;
  }

  const TemporaryFolder folder;
  const fs::path data = path("data"), tar = path("backup.tar");
  Installation installation = open_installation({.folder = data}).value();
};

TEST_F(BackupTest, TheRestoredInstallationEqualsTheOriginal) {
  const ModelId shown = publish("Shown"), draft = publish("Draft", ModelState::kDraft),
                capped = publish_capped("Capped");
  ASSERT_TRUE(installation.catalogue->add_token(
      {.id = TokenId::generate(), .role = Role::kAdmin, .hash = Sha256{7}, .label = "door"}));
  fs::create_directories(data / "scans/one");
  write(data / "scans/one/profiles", "measured");
  write(data / "scans/one/.half.part", "not yet");
  fs::create_directories(data / "scans/.removed-two");
  write(data / "scans/.removed-two/profiles", "being deleted");
  const auto report = back_up(data, tar);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->models, 3u);
  EXPECT_EQ(report->files, 6u);
  const auto restored = restore(tar, path("again"));
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->models, 3u);
  EXPECT_EQ(restored->bytes, report->bytes);
  Installation again = open_installation({.folder = path("again")}).value();
  const auto bytes_of = [](const Installation& in, const ModelRecord& model) {
    return in.store->open(model.file).value()->read(0, model.file_bytes).value();
  };
  for (const ModelId& id : {shown, draft, capped}) {
    const ModelRecord before = installation.catalogue->find(id).value().value();
    const ModelRecord after = again.catalogue->find(id).value().value();
    EXPECT_EQ(after.title, before.title);
    EXPECT_EQ(after.state, before.state);
    EXPECT_EQ(after.repairs, "1 face dropped");
    EXPECT_EQ(bytes_of(again, after), bytes_of(installation, before));
    EXPECT_EQ(bytes_of(again, public_view(after)), bytes_of(installation, public_view(before)));
  }
  EXPECT_EQ(again.catalogue->tokens_like(Sha256{7}).value().size(), 1u);
  EXPECT_EQ(slurp(path("again/scans/one/profiles")), "measured");
  EXPECT_FALSE(fs::exists(path("again/scans/one/.half.part")));
}

TEST_F(BackupTest, ABackupWithoutAPublicPartIsRefused) {
  const ModelId id = publish_capped("Capped");
  ASSERT_TRUE(back_up(data, tar));
  const std::string hex =
      to_hex(installation.catalogue->find(id).value().value().public_part.value().file);
  auto reader = TarReader::open(tar).value();
  auto writer = TarWriter::create(path("less.tar")).value();
  for (auto entry = reader.next().value(); entry; entry = reader.next().value()) {
    if (entry->name.ends_with(hex)) continue;
    std::string text(entry->bytes.begin(), entry->bytes.end());
    if (entry->name == kChecksums) {
      const std::size_t end = text.find(hex + "\n") + hex.size() + 1;
      text.erase(text.rfind('\n', end - 2) + 1, end - text.rfind('\n', end - 2) - 1);
    }
    ASSERT_TRUE(writer.add(entry->name, to_bytes(text)));
  }
  ASSERT_TRUE(writer.finish());
  EXPECT_THAT(fault_of_restoring(path("less.tar")),
              HasSubstr("the file of model " + id.to_string() + " is missing"));
}

TEST_F(BackupTest, OnlyItsOwnerCanReadItFromTheFirstByteOn) {
  publish("Shown");
  const mode_t mask = ::umask(0);
  const auto done = back_up(data, tar);
  const auto copied = snapshot_sqlite(data / kCatalogueFile, path("copy"));
  auto unfinished = TarWriter::create(path("unfinished.tar"));
  ::umask(mask);
  ASSERT_TRUE(done && copied && unfinished);
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    if (entry.is_directory()) continue;
    EXPECT_EQ(entry.status().permissions(), fs::perms::owner_read | fs::perms::owner_write)
        << entry.path();
  }
  EXPECT_EQ(names_in(folder.path()).size(), 4u);
}

TEST_F(BackupTest, OnlyTheOwnerCanEnterARestoredFolderAndReadItsCatalogue) {
  publish("Shown");
  ASSERT_TRUE(back_up(data, tar));
  const mode_t mask = ::umask(0);
  const auto restored = restore(tar, path("again"));
  ::umask(mask);
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(fs::status(path("again")).permissions(), fs::perms::owner_all);
  EXPECT_EQ(fs::status(path("again/catalogue.sqlite")).permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(BackupTest, OrdinaryToolsReadAndCheckIt) {
  publish("Shown");
  ASSERT_TRUE(back_up(data, tar));
  fs::create_directory(path("unpacked"));
  EXPECT_EQ(
      run_program({"/bin/tar", "-xf", tar.string(), "-C", path("unpacked").string()}).exit_code, 0);
  const std::string check = fmt::format("cd {} && sha256sum --check --strict --quiet SHA256SUMS",
                                        path("unpacked").string());
  EXPECT_EQ(run_program({"/bin/sh", "-c", check}).exit_code, 0);
}

TEST_F(BackupTest, IsConsistentWhileOthersPublish) {
  constexpr int kModels = 16;
  std::atomic<int> published = 0;
  std::thread others([&] {
    for (int i = 0; i < kModels; ++i, ++published)
      publish("Model " + std::to_string(i));
  });
  while (published == 0)  // waits until the other thread has published a model
    std::this_thread::yield();
  for (bool last = false; !last;) {
    last = published == kModels;
    const auto before = static_cast<std::uint64_t>(published);
    const auto saved = back_up(data, tar);
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_GE(saved->models, before);
    const auto restored = restore(tar, path("again"));
    ASSERT_TRUE(restored) << restored.error().message;
    EXPECT_EQ(restored->models, saved->models);
    fs::remove_all(path("again"));
  }
  others.join();
}

TEST_F(BackupTest, NothingIsEverOverwritten) {
  publish("Shown");
  ASSERT_TRUE(back_up(data, tar));
  const auto over = restore(tar, data);
  ASSERT_FALSE(over);
  EXPECT_THAT(over.error().message, HasSubstr("is not empty; restore into a new folder"));
  EXPECT_EQ(installation.catalogue->search({}).value().models.size(), 1u);
}

TEST_F(BackupTest, ACutOrDamagedFileIsRefusedAndLeavesNothing) {
  publish("Shown");
  ASSERT_TRUE(back_up(data, tar));
  const std::string whole = slurp(tar);
  const fs::path damaged = path("damaged.tar");
  for (std::size_t length = 0; length + 1024 < whole.size(); length += 4000) {
    write(damaged, whole.substr(0, length));
    fault_of_restoring(damaged);
  }
  const std::size_t object = whole.find("base of Shown"), catalogue = whole.rfind("Shown");
  for (const std::size_t at : {object, catalogue, whole.rfind("catalogue.sqlite") - 10}) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 1);
    write(damaged, flipped);
    EXPECT_THAT(fault_of_restoring(damaged), HasSubstr("; take another"));
  }
}

TEST_F(BackupTest, AnEntryThatDoesNotBelongInABackupIsRefused) {
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  for (const char* name :
       {"../escaped", "scans/../../escaped", "/escaped", "scans/.hidden", "scans//x", "scans/",
        "objects/00/00/nonsense", "catalogue.sqlite-wal", "other"}) {
    auto writer = TarWriter::create(tar).value();
    ASSERT_TRUE(writer.add(name, bytes));
    ASSERT_TRUE(writer.finish());
    fault_of_restoring(tar);
    EXPECT_FALSE(fs::exists(path("escaped")));
  }
}

TEST_F(BackupTest, DamagedFilesAreListedAndTheRestIsSavedAndRestored) {
  const ModelId sound = publish("Sound"), damaged = publish("Damaged"), lost = publish("Lost"),
                unopened = publish("Unopened");
  const auto path_of = [&](const ModelId& id) {
    return object_path(installation.catalogue->find(id).value()->file);
  };
  write(data / path_of(damaged), slurp(data / path_of(damaged)) + "!");
  fs::remove(data / path_of(lost));
  fs::remove(data / path_of(unopened));
  fs::create_symlink(data / path_of(unopened), data / path_of(unopened));  // cannot be opened
  const auto saved = back_up(data, tar);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_THAT(
      saved->damaged,
      UnorderedElementsAre(path_of(damaged) + " of model " + damaged.to_string() + " is damaged",
                           path_of(unopened) + " of model " + unopened.to_string() + " is damaged",
                           path_of(lost) + " of model " + lost.to_string() + " is missing"));
  const auto restored = restore(tar, path("again"));
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->models, 4u);
  EXPECT_EQ(restored->files, saved->files);
  EXPECT_EQ(restored->damaged.size(), 3u);
  EXPECT_EQ(slurp(path("again") / path_of(sound)), slurp(data / path_of(sound)));
  EXPECT_FALSE(fs::exists(path("again") / path_of(damaged)));
  EXPECT_FALSE(fs::exists(path("again") / path_of(lost)));
}

TEST_F(BackupTest, AScanFileThatCannotBeReadIsListed) {
  publish("Shown");
  fs::create_directories(data / "scans/one");
  write(data / "scans/one/profiles", "measured");
  write(data / "scans/one/steps", "");
  fs::resize_file(data / "scans/one/steps", TarReader::kMaxFile + 1);  // too large for a backup
  const auto saved = back_up(data, tar);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_THAT(saved->damaged, ElementsAre("scans/one/steps cannot be read"));
  ASSERT_TRUE(restore(tar, path("again")));
  EXPECT_EQ(slurp(path("again/scans/one/profiles")), "measured");
}

TEST_F(BackupTest, AFolderOfScansThatCannotBeReadIsListed) {
  publish("Shown");
  fs::remove_all(data / "scans");
  fs::create_symlink(data / "scans", data / "scans");  // a symbolic link to itself
  const auto saved = back_up(data, tar);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_THAT(saved->damaged, ElementsAre("scans cannot be read"));
  EXPECT_EQ(restore(tar, path("again")).value().models, 1u);
}

TEST_F(BackupTest, ADamagedCatalogueIsSavedAndListed) {
  publish("Shown");
  sqlite::SqliteHandle(data / kCatalogueFile)
      .run("PRAGMA foreign_keys = OFF; INSERT INTO chunk VALUES (x'01', x'02', 3, 4)");
  const auto saved = back_up(data, tar);
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_THAT(saved->damaged, ElementsAre(HasSubstr("catalogue.sqlite: a row of the table chunk")));
  EXPECT_TRUE(restore(tar, path("again")));
}

}  // namespace
}  // namespace vitrine::test
