// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <future>
#include <optional>

#include "server/store/installation.h"
#include "server/store/published_model.h"
#include "server/store/uploads.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "vitrine_command.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;

TEST_F(VitrineCommand, AnOpenInstallationServesAModelPublishedBesideIt) {
  const std::string data = path("data");
  const auto installation = open_installation({.folder = data}).value();
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

TEST_F(VitrineCommand, APmeshIsPublishedAsItIs) {
  const std::string file = model(800);
  const nlohmann::json report =
      vitrine_json({"publish", file, "--data", empty_folder("data"), "--title", "Torus"});
  const auto installation = open_installation({.folder = path("data")}).value();
  PublishedModels models(*installation.store, *installation.catalogue);
  const auto found = models.find(*ModelId::parse(report["id"].get<std::string>())).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->record().title, "Torus");
  const auto bytes = found->read(found->whole()).value();
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()), read("model.pmesh"));
}

TEST_F(VitrineCommand, PublishingAMeshAgainGivesTheSameModelAndSaysSo) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  const nlohmann::json first = vitrine_json({"publish", in, "--data", data});
  const ProgramResult again = vitrine({"publish", in, "--data", data, "--json"});
  expect_fault(again, 0);
  EXPECT_THAT(again.errors, HasSubstr("note: " + in + " is published under this title already"));
  EXPECT_EQ(nlohmann::json::parse(again.output), first);
}

TEST_F(VitrineCommand, PublishingBesideTheDaemonKeepsToItsQuota) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  { const Daemon daemon(data, {"--quota", "100"}); }
  const std::string file = write("vitrined.conf", "data = " + data + "\nquota = 100\n");
  for (const std::string& place : {data, file}) {
    const ProgramResult refused = vitrine({"publish", in, "--data", place});
    expect_fault(refused, 1);
    EXPECT_THAT(refused.errors, HasSubstr("0 of 100 bytes are taken"));
  }
  const std::string uploads = empty_folder("uploads");
  ASSERT_TRUE(Uploads(uploads, {.bytes = 100, .per_token = 1}).create(TokenId::generate(), 60, ""));
  const std::string shared =
      write("shared.conf", "data = " + data + "\nquota = 100\nuploads = " + uploads + "\n");
  EXPECT_THAT(vitrine({"publish", in, "--data", shared}).errors,
              HasSubstr("60 of 100 bytes are taken"));
  { const Daemon daemon(data); }
  vitrine_json({"publish", in, "--data", data});
}

TEST_F(VitrineCommand, AnUnreadableDataFolderIsNamed) {
  // the name is too long for any file system
  const std::string folder = path(std::string(300, 'd'));
  const ProgramResult result =
      vitrine({"publish", write("in.ply", bumpy_ply(500)), "--data", folder});
  expect_fault(result, 1);
  EXPECT_THAT(result.errors, HasSubstr("File name too long"));
}

TEST_F(VitrineCommand, AMistypedDataFolderBecomesNoInstallation) {
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
      HasSubstr("contains other files and no catalogue; give the folder of an installation, or "
                "start vitrined with an empty one once"));
  EXPECT_THAT(files(), testing::ElementsAre("in.ply"));
}

TEST_F(VitrineCommand, RemainsOfAnInterruptedStartAndTheDemoAreAccepted) {
  const std::string in = write("in.ply", bumpy_ply(500)), data = empty_folder("data");
  for (const char* name : {"data/objects", "data/demo", "data/lost+found"})
    empty_folder(name);
  vitrine_json({"publish", in, "--data", data});
}

TEST_F(VitrineCommand, ADamagedPmeshIsNotPublished) {
  model(800);
  const std::string whole = read("model.pmesh");
  const std::string cut = whole.substr(0, whole.size() - 1);
  expect_fault(vitrine({"publish", write("bad.pmesh", cut), "--data", empty_folder("data")}), 1);
  EXPECT_TRUE(std::filesystem::is_empty(path("data")));
}

TEST_F(VitrineCommand, AMeshIsPublishedOverARestartOfTheServer) {
  const std::string data = empty_folder("data"), in = write("in.ply", bumpy_ply(40'000));
  const std::string by =
      vitrine_json({"token", "create", "--role", "operator", "--data", data}).value("token", "");
  std::optional<Daemon> daemon(std::in_place, data);
  const std::string at = "127.0.0.1:" + std::to_string(daemon->port());
  auto publishing = std::async(std::launch::async, [&] {
    return vitrine_json({"publish", in, "--server", "http://" + at, "--token", by});
  });
  daemon->wait_for_line("route=/api/v1/models ");
  daemon.reset();  // kills the daemon during the job
  daemon.emplace(data, std::vector<std::string>{"--listen", at});
  const std::string id = publishing.get().value("id", "");
  EXPECT_EQ(http_get(daemon->port(), "/api/v1/models/" + id).status, 200);
}

// A fixture with a daemon. Creates tokens for it.
class AtServer : public VitrineCommand {
 protected:
  AtServer() : daemon_(empty_folder("data")) {}

  std::string token(const std::string& role) const {
    return vitrine_json({"token", "create", "--role", role, "--data", path("data")})["token"];
  }
  std::vector<std::string> at_server(std::vector<std::string> words, const std::string& by) const {
    words.insert(words.end(), {"--server", url_, "--token", by});
    return words;
  }

  const Daemon daemon_;
  const std::string url_ = "http://127.0.0.1:" + std::to_string(daemon_.port());
};

TEST_F(AtServer, AMeshIsPublicOnReturn) {
  const std::string in = write("Bust of a girl.ply", bumpy_ply(2'000)), by = token("operator");
  const nlohmann::json report = vitrine_json(at_server({"publish", in}, by));
  EXPECT_EQ(report.size(), 2u);
  const std::string id = report["id"];
  EXPECT_EQ(report["url"], url_ + "/models/" + id);
  const auto shown = nlohmann::json::parse(http_get(daemon_.port(), "/api/v1/models/" + id).body);
  EXPECT_EQ(shown["title"], "Bust of a girl");
  EXPECT_EQ(shown["faces"], 1'922);
  const nlohmann::json other = vitrine_json(at_server({"publish", model(800), "--title", "T"}, by));
  const std::string file =
      http_get(daemon_.port(), "/api/v1/models/" + other.value("id", "") + "/file.pmesh").body;
  EXPECT_EQ(file, read("model.pmesh"));
}

TEST_F(AtServer, ARefusalIsReportedInTheServersWords) {
  const std::string in = write("in.ply", "no mesh"), by = token("operator");
  const ProgramResult bad = vitrine(at_server({"publish", in}, by));
  expect_fault(bad, 1);
  EXPECT_THAT(bad.errors, HasSubstr("in.ply: "));
  const ProgramResult forbidden = vitrine(at_server({"publish", in}, token("viewer")));
  expect_fault(forbidden, 1);
  EXPECT_THAT(forbidden.errors, HasSubstr("403"));
  expect_fault(vitrine({"publish", in, "--server", "museum", "--token", by}), 2);
  expect_fault(vitrine({"publish", in, "--server", url_}), 2);
}

TEST_F(AtServer, AnAdministratorMakesAndRevokesTokensRemotely) {
  const std::string admin = token("admin");
  const nlohmann::json made =
      vitrine_json(at_server({"token", "create", "--role", "viewer", "--label", "Anna"}, admin));
  EXPECT_EQ(made["role"], "viewer");
  const std::string bearer = "Authorization: Bearer " + made.value("token", "") + "\r\n";
  EXPECT_EQ(http_get(daemon_.port(), "/api/v1/jobs", bearer).status, 200);
  vitrine_json(at_server({"token", "revoke", "--id", made["id"]}, admin));
  EXPECT_EQ(http_get(daemon_.port(), "/api/v1/jobs", bearer).status, 401);
}

}  // namespace
}  // namespace vitrine::test
