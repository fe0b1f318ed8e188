// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "server/store/installation.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

// Flips a bit of the only object in the data folder. Returns the object's SHA-256.
std::string damage_object(const std::filesystem::path& data) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data / "objects")) {
    if (!entry.is_regular_file()) continue;
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(1000);
    const int byte = file.get();
    file.seekp(1000).put(static_cast<char>(byte ^ 1));
    return entry.path().filename().string();
  }
  throw std::runtime_error("no object in " + data.string());
}

// Returns the doctor's verdict on the objects in the data folder.
std::string verdict_on_objects(const std::string& data) {
  const auto result = run_program({kVitrine, "doctor", "--data", data, "--scrub", "--json"});
  const auto checks = nlohmann::json::parse(result.output)["checks"];
  const auto found = std::ranges::find_if(
      checks, [](const nlohmann::json& check) { return check["check"] == "objects"; });
  return found == checks.end() ? "" : (*found)["verdict"].get<std::string>();
}

TEST_F(VitrineCommand, BacksUpAnInstallationAndRestoresIt) {
  const std::string data = empty_folder("data");
  const std::string id = vitrine_json({"publish", model(), "--data", data})["id"];
  const auto saved = vitrine_json({"backup", "--data", data, "-o", path("backup.tar")});
  EXPECT_EQ(saved["models"], 1);
  const auto restored = vitrine_json({"restore", path("backup.tar"), "--data", path("again")});
  EXPECT_EQ(restored, saved);
  const auto catalogue = open_installation({.folder = path("again")}).value();
  EXPECT_TRUE(catalogue.catalogue->find(*ModelId::parse(id)).value());
}

TEST_F(VitrineCommand, AFolderWithoutAnInstallationIsNotBackedUp) {
  expect_fault(vitrine({"backup", "--data", empty_folder("none"), "-o", path("backup.tar")}), 1);
  expect_fault(vitrine({"backup", "--data", path("none")}), 2);
  expect_fault(vitrine({"restore", path("none.tar"), "--data", path("again")}), 1);
  expect_fault(vitrine({"restore", path("none.tar")}), 2);
  EXPECT_THAT(files(), ::testing::ElementsAre("none"));
}

TEST_F(VitrineCommand, ABackupReplacesAnotherOnlyByForce) {
  const std::string data = empty_folder("data"), tar = write("backup.tar", "precious");
  vitrine_json({"publish", model(), "--data", data});
  const auto refused = vitrine({"backup", "--data", data, "-o", tar});
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("backup.tar exists; choose another name"));
  EXPECT_EQ(read("backup.tar"), "precious");
  EXPECT_EQ(vitrine_json({"backup", "--data", data, "-o", tar, "--force"})["models"], 1);
  EXPECT_EQ(vitrine_json({"restore", tar, "--data", path("again")})["models"], 1);
}

TEST_F(VitrineCommand, ADamagedFileIsFoundLeftOutOfABackupAndPutBackFromAnOlderOne) {
  const std::string data = empty_folder("data"), tar = path("backup.tar"),
                    later = path("later.tar");
  vitrine_json({"publish", model(), "--data", data});
  vitrine_json({"backup", "--data", data, "-o", tar});
  EXPECT_EQ(verdict_on_objects(data), "ok");
  const auto damaged = damage_object(data);
  const auto doctor = vitrine({"doctor", "--data", data, "--scrub"});
  EXPECT_EQ(doctor.exit_code, 1);
  EXPECT_THAT(doctor.output, ::testing::HasSubstr("object " + damaged));
  const auto saved = vitrine({"backup", "--data", data, "-o", later});
  expect_fault({saved.exit_code, "", saved.errors}, 1);
  EXPECT_THAT(saved.output, ::testing::HasSubstr(damaged));
  EXPECT_TRUE(std::filesystem::exists(later));
  expect_fault(vitrine({"repair", "--data", data, "--backup", later}), 1);
  const auto done = vitrine_json({"repair", "--data", data, "--backup", tar});
  EXPECT_EQ(done["repaired"].at(0)["object"], damaged);
  EXPECT_EQ(done["damaged"].size(), 0u);
  EXPECT_EQ(verdict_on_objects(data), "ok");
}

TEST_F(VitrineCommand, ADamagedFileIsPutBackFromAnotherInstallation) {
  const std::string data = empty_folder("data"), other = path("other");
  vitrine_json({"publish", model(), "--data", data});
  vitrine_json({"backup", "--data", data, "-o", path("backup.tar")});
  vitrine_json({"restore", path("backup.tar"), "--data", other});
  damage_object(data);
  const auto done = vitrine_json({"repair", "--data", data, "--from", other});
  EXPECT_EQ(done["repaired"].size(), 1u);
  expect_fault(vitrine({"repair", "--data", data}), 2);
  expect_fault(vitrine({"repair", "--data", data, "--from", other, "--backup", "x.tar"}), 2);
  expect_fault(vitrine({"repair", "--backup", "x.tar"}), 2);
  expect_fault(vitrine({"doctor", "--scrub"}), 2);
}

TEST_F(VitrineCommand, AMigrationListsDamagedFilesAndCopiesTheRest) {
  const std::string data = empty_folder("data"), to = empty_folder("to");
  vitrine_json({"publish", model(), "--data", data});
  const auto damaged = damage_object(data);
  const auto moved = vitrine({"migrate", "--from", data, "--to", to});
  expect_fault({moved.exit_code, "", moved.errors}, 1);
  EXPECT_THAT(moved.output, ::testing::HasSubstr("object " + damaged));
  EXPECT_THAT(moved.errors, ::testing::HasSubstr("vitrine repair --data " + to + " --backup FILE"));
  EXPECT_THAT(moved.output, ::testing::HasSubstr("1 models, 0 files, 0 bytes"));
}

TEST_F(VitrineCommand, MigrationsAndRepairsKeepTheDiskReserveOfTheirDestinationFree) {
  const std::string data = empty_folder("data"), other = path("other"), to = empty_folder("to");
  const std::string reserve = "9000000000000000000";
  const auto conf = [&](const std::string& name, const std::string& folder) {
    return write(name, "data = " + folder + "\ndisk-reserve = " + reserve + "\n");
  };
  vitrine_json({"publish", model(), "--data", data});
  vitrine_json({"backup", "--data", data, "-o", path("backup.tar")});
  vitrine_json({"restore", path("backup.tar"), "--data", other});
  const auto refused = vitrine({"migrate", "--from", data, "--to", conf("to.conf", to)});
  expect_fault(refused, 1);
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("keeps " + reserve + " free"));
  EXPECT_EQ(vitrine({"migrate", "--from", data, "--to", to}).exit_code, 0);
  std::filesystem::remove_all(data + "/objects");
  const auto also = vitrine({"repair", "--data", conf("data.conf", data), "--from", other});
  expect_fault(also, 1);
  EXPECT_THAT(also.errors, ::testing::HasSubstr("keeps " + reserve + " free"));
}

}  // namespace
}  // namespace vitrine::test
