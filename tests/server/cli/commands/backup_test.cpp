// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "server/store/installation.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

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

}  // namespace
}  // namespace vitrine::test
