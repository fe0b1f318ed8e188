// SPDX-License-Identifier: Apache-2.0
#include "server/app/remote_installation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/store/publish.h"
#include "server/store/s3_client.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/process/run_program.h"
#include "support/product_names.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::string kVitrine = VITRINE_BIN_DIR "/vitrine";

std::string publish_at(const InstallationPlace& place, const std::string& title) {
  const auto installation = open_installation(place).value();
  const auto pmesh = tiny_pmesh("a base", "a chunk of " + title);
  return publish(*installation.store, *installation.catalogue, pmesh.bytes, {.title = title})
      .value()
      .id.to_string();
}

int status_of(std::uint16_t port, const std::string& target) {
  return HttpClient(port).get(target).status;
}

std::string file_of(const std::string& id) {
  return "/api/v1/models/" + id + "/file.pmesh";
}

TEST(RemoteInstallation, ADaemonServesWhatIsInABucketAndADatabase) {
  const RemoteInstallation remote;
  const Daemon daemon(remote.place().folder, {"--config", remote.file()});
  const std::string id = publish_at(remote.place(), "vase");
  const auto pmesh = tiny_pmesh("a base", "a chunk of vase");
  EXPECT_EQ(HttpClient(daemon.port()).get(file_of(id)).body,
            std::string(pmesh.bytes.begin(), pmesh.bytes.end()));
  const auto token =
      run_program({kVitrine, "token", "create", "--role", "viewer", "--data", remote.file()});
  EXPECT_EQ(token.exit_code, 0) << token.errors;
  EXPECT_FALSE(std::filesystem::exists(remote.place().folder / kCatalogueFile));
  EXPECT_FALSE(std::filesystem::exists(remote.place().folder / "objects"));
}

TEST(RemoteInstallation, WhileTheDatabaseIsAwayWhatIsKnownIsServedOn) {
  const RemoteInstallation remote;
  const std::string id = publish_at(remote.place(), "vase");
  const std::string other = publish_at(remote.place(), "bowl");
  Daemon daemon(remote.place().folder, {"--config", remote.file()});
  ASSERT_EQ(status_of(daemon.port(), file_of(id)), 200);
  ASSERT_EQ(status_of(daemon.admin_port(), "/readyz"), 200);
  stop_postgres();
  EXPECT_EQ(status_of(daemon.admin_port(), "/readyz"), 503);
  EXPECT_EQ(status_of(daemon.port(), file_of(id)), 200);
  EXPECT_GE(status_of(daemon.port(), file_of(other)), 500);
  EXPECT_EQ(status_of(daemon.admin_port(), "/livez"), 200);
  start_postgres();
  while (status_of(daemon.admin_port(), "/readyz") != 200)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(status_of(daemon.port(), file_of(other)), 200);
  EXPECT_THAT(daemon.wait_for_line("event=error"), HasSubstr("cannot use the catalogue"));
}

TEST(RemoteInstallation, NoSecretIsPrinted) {
  const RemoteInstallation remote;
  const auto printed = run_vitrined({"--config", remote.file(), "--print-config"});
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_THAT(printed.output, HasSubstr(remote.place().store));
  EXPECT_THAT(printed.output, HasSubstr("# catalogue is not shown"));
  EXPECT_THAT(printed.output, Not(HasSubstr(kPostgresPassword)));
  EXPECT_THAT(printed.output, Not(HasSubstr(kGatewayKeys.secret)));
}

TEST(RemoteInstallation, AStartWithAWrongSecretSaysSo) {
  const RemoteInstallation remote;
  const auto ended = run_vitrined(
      {"--config", remote.file(), "--listen", "127.0.0.1:0", "--store-secret-key", "another"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.output, HasSubstr("403 SignatureDoesNotMatch; check store-access-key"));
}

TEST(RemoteInstallation, TheDoctorLooksAtBoth) {
  const RemoteInstallation remote;
  publish_at(remote.place(), "vase");
  const auto well = run_program({kVitrine, "doctor", "--data", remote.file()});
  EXPECT_EQ(well.exit_code, 0) << well.output << well.errors;
  EXPECT_THAT(well.output, HasSubstr("allows write, read, list and remove"));
  EXPECT_THAT(well.output, HasSubstr("1 models, all files present"));
  const auto installation = open_installation(remote.place()).value();
  ASSERT_TRUE(installation.store->remove(installation.catalogue->files().value().front().file));
  const auto ill = run_program({kVitrine, "doctor", "--data", remote.file()});
  EXPECT_EQ(ill.exit_code, 1);
  EXPECT_THAT(ill.output, HasSubstr("the files of 1 of 1 models are missing"));
}

TEST(RemoteInstallation, ADamagedObjectOfTheBucketIsFoundAndPutBackFromAFolder) {
  const RemoteInstallation remote;
  const TemporaryFolder copy;
  const std::string id = publish_at(remote.place(), "vase");
  publish_at({.folder = copy.path()}, "vase");
  auto bytes = tiny_pmesh("a base", "a chunk of vase").bytes;
  const std::string hex = to_hex(sha256(bytes));
  bytes.back() ^= 1;
  S3Client client(S3Address::parse(remote.place().store).value(), kGatewayKeys);
  ASSERT_TRUE(s3_upload(client, "objects/" + hex, bytes, 5 << 20));
  Daemon daemon(remote.place().folder, {"--config", remote.file()});
  EXPECT_THAT(daemon.wait_for_line("event=error"), HasSubstr("object " + hex));
  EXPECT_EQ(status_of(daemon.port(), file_of(id)), 500);
  daemon.wait_for_line("event=error");
  const auto ill = run_program({kVitrine, "doctor", "--data", remote.file(), "--scrub"});
  EXPECT_EQ(ill.exit_code, 1);
  EXPECT_THAT(ill.output, HasSubstr(hex));
  const auto mended =
      run_program({kVitrine, "repair", "--data", remote.file(), "--from", copy.path().string()});
  EXPECT_EQ(mended.exit_code, 0) << mended.errors;
  EXPECT_EQ(status_of(daemon.port(), file_of(id)), 200);
  const auto well = run_program({kVitrine, "doctor", "--data", remote.file(), "--scrub"});
  EXPECT_EQ(well.exit_code, 0) << well.output;
  EXPECT_THAT(well.output, HasSubstr("all intact"));
}

TEST(RemoteInstallation, TheCommandMigratesAnInstallation) {
  const RemoteInstallation remote;
  const TemporaryFolder folder;
  const auto id = ModelId::parse(publish_at({.folder = folder.path()}, "vase")).value();
  const auto catalogue_of = [](const InstallationPlace& place) {
    return open_installation(place).value().catalogue;
  };
  ModelRecord model = catalogue_of({.folder = folder.path()})->find(id).value().value();
  model.repairs = "1 duplicate face dropped";
  ASSERT_TRUE(catalogue_of({.folder = folder.path()})->update(model, std::nullopt));
  const auto moved = run_program(
      {kVitrine, "migrate", "--from", folder.path().string(), "--to", remote.file(), "--json"});
  EXPECT_EQ(moved.exit_code, 0) << moved.errors;
  EXPECT_THAT(moved.output, HasSubstr("\"models\":1"));
  const auto catalogue = catalogue_of(remote.place());
  EXPECT_EQ(catalogue->files().value().size(), 1u);
  EXPECT_EQ(catalogue->find(id).value().value().repairs, model.repairs);
}

}  // namespace
}  // namespace vitrine::test
