// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "server/store/installation.h"
#include "server/store/published_model.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

TEST_F(VitrineCommand, what_is_published_is_served_by_an_installation_that_is_open_already) {
  const std::string data = path("data");
  const auto installation = open_installation(data).value();
  PublishedModels models(*installation.store, *installation.catalogue);
  const std::string in = write("Bust of a girl.ply", bumpy_ply(2'000));
  const nlohmann::json report = vitrine_json({"publish", in, "--data", data});
  EXPECT_EQ(report.size(), 2u);
  EXPECT_EQ(report["url"], nullptr);
  const auto id = ModelId::parse(report["id"].get<std::string>());
  ASSERT_TRUE(id);
  const auto model = models.find(*id).value();
  ASSERT_TRUE(model);
  EXPECT_EQ(model->record().title, "Bust of a girl");
  EXPECT_EQ(model->record().faces, 1'922u);
}

TEST_F(VitrineCommand, a_pmesh_is_published_as_it_is) {
  const std::string file = model(800);
  const nlohmann::json report =
      vitrine_json({"publish", file, "--data", empty_folder("data"), "--title", "Torus"});
  const auto installation = open_installation(path("data")).value();
  PublishedModels models(*installation.store, *installation.catalogue);
  const auto found = models.find(*ModelId::parse(report["id"].get<std::string>())).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->record().title, "Torus");
  const auto bytes = found->read(found->whole()).value();
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), read("model.pmesh"));
}

TEST_F(VitrineCommand, publishing_a_mesh_again_gives_the_same_model_and_says_so) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  const nlohmann::json first = vitrine_json({"publish", in, "--data", data});
  const ProgramResult again = vitrine({"publish", in, "--data", data, "--json"});
  expect_fault(again, 0);
  EXPECT_THAT(again.errors, HasSubstr("note: " + in + " is published under this title already"));
  EXPECT_EQ(nlohmann::json::parse(again.output), first);
}

TEST_F(VitrineCommand, a_data_folder_that_cannot_be_looked_at_is_named) {
  const std::string folder = path(std::string(300, 'd'));  // no file system has such names
  const ProgramResult result =
      vitrine({"publish", write("in.ply", bumpy_ply(500)), "--data", folder});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("File name too long"));
}

TEST_F(VitrineCommand, a_mistyped_data_folder_becomes_no_installation) {
  const std::string in = write("in.ply", bumpy_ply(500));
  const ProgramResult absent = vitrine({"publish", in, "--data", path("absent")});
  expect_fault(absent, 1);
  EXPECT_THAT(
      absent.errors,
      HasSubstr("absent: No such file or directory; give the folder of an installation, or start "
                "vitrined with this one once"));
  const ProgramResult other = vitrine({"publish", in, "--data", folder_.path().string()});
  expect_fault(other, 1);
  EXPECT_THAT(
      other.errors,
      HasSubstr("holds other things and no catalogue; give the folder of an installation, or "
                "start vitrined with an empty one once"));
  EXPECT_THAT(files(), testing::ElementsAre("in.ply"));
}

TEST_F(VitrineCommand, what_an_interrupted_start_and_the_demo_leave_is_no_other_thing) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  for (const char* name : {"data/objects", "data/demo", "data/lost+found"})
    empty_folder(name);
  vitrine_json({"publish", in, "--data", data});
}

TEST_F(VitrineCommand, a_damaged_pmesh_is_not_published) {
  model(800);
  const std::string whole = read("model.pmesh");
  const std::string cut = whole.substr(0, whole.size() - 1);
  expect_fault(vitrine({"publish", write("bad.pmesh", cut), "--data", empty_folder("data")}), 1);
  EXPECT_TRUE(std::filesystem::is_empty(path("data")));
}

TEST_F(VitrineCommand, a_remote_server_is_refused_with_the_way_round) {
  const std::string in = write("in.ply", bumpy_ply(100));
  const ProgramResult result =
      vitrine({"publish", in, "--server", "http://127.0.0.1:1", "--token", "t"});
  expect_fault(result, 1);
  EXPECT_NE(result.errors.find("--data"), std::string::npos);
}

}  // namespace
}  // namespace vitrine::test
