// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "server/backup/tar.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/run_program.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
    const auto done = vitrine::publish(*installation.store, *installation.catalogue,
                                       tiny_pmesh("base of " + title, "chunk").bytes,
                                       {.title = title}, {.state = state});
    if (!done) throw std::runtime_error(done.error().message);
    return done->id;
  }
  fs::path path(const std::string& name) const { return folder.path() / name; }

  // What restoring says, and that it leaves nothing behind.
  std::string fault_of_restoring(const fs::path& backup) const {
    const auto done = restore(backup, path("again"));
    EXPECT_FALSE(done);
    EXPECT_FALSE(fs::exists(path("again")));
    return done ? "" : done.error().message;
  }

  const TemporaryFolder folder;
  const fs::path data = path("data"), tar = path("backup.tar");
  Installation installation = open_installation(data).value();
};

TEST_F(BackupTest, WhatIsRestoredIsWhatThereWas) {
  const ModelId shown = publish("Shown"), draft = publish("Draft", ModelState::kDraft);
  ASSERT_TRUE(installation.catalogue->add_token(
      {.id = ModelId::generate(), .role = Role::kAdmin, .hash = Sha256{7}, .label = "door"}));
  fs::create_directories(data / "scans/one");
  write(data / "scans/one/profiles", "measured");
  write(data / "scans/one/.half.part", "not yet");
  const auto report = back_up(data, tar);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->models, 2u);
  EXPECT_EQ(report->files, 4u);
  const auto restored = restore(tar, path("again"));
  ASSERT_TRUE(restored) << restored.error().message;
  EXPECT_EQ(restored->models, 2u);
  EXPECT_EQ(restored->bytes, report->bytes);
  Installation again = open_installation(path("again")).value();
  for (const ModelId& id : {shown, draft}) {
    const ModelRecord before = installation.catalogue->find(id).value().value();
    const ModelRecord after = again.catalogue->find(id).value().value();
    EXPECT_EQ(after.title, before.title);
    EXPECT_EQ(after.state, before.state);
    EXPECT_EQ(again.store->open(after.file).value()->read(0, after.file_bytes).value(),
              installation.store->open(before.file).value()->read(0, before.file_bytes).value());
  }
  EXPECT_EQ(again.catalogue->tokens_like(Sha256{7}).value().size(), 1u);
  EXPECT_EQ(slurp(path("again/scans/one/profiles")), "measured");
  EXPECT_FALSE(fs::exists(path("again/scans/one/.half.part")));
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
  while (published == 0)  // they are at it
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

TEST_F(BackupTest, WhatDoesNotBelongIntoOneIsRefused) {
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

TEST_F(BackupTest, ADamagedObjectIsNamedAndNoFileIsLeft) {
  const ModelId id = publish("Shown");
  const ModelRecord model = installation.catalogue->find(id).value().value();
  const std::string hex = to_hex(model.file);
  const fs::path object = data / "objects" / hex.substr(0, 2) / hex.substr(2, 2) / hex;
  fs::permissions(object, fs::perms::owner_all);
  write(object, slurp(object) + "!");
  const auto damaged = back_up(data, tar);
  ASSERT_FALSE(damaged);
  EXPECT_THAT(damaged.error().message, HasSubstr(hex + " is damaged"));
  fs::remove(object);
  const auto missing = back_up(data, tar);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("the file of model " + id.to_string()));
  EXPECT_THAT(names_in(folder.path()), ::testing::ElementsAre("data"));
}

}  // namespace
}  // namespace vitrine::test
