// SPDX-License-Identifier: Apache-2.0
#include "server/app/elsewhere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "server/store/publish.h"
#include "support/daemon.h"
#include "support/http_client.h"
#include "support/run_program.h"
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

TEST(Elsewhere, a_daemon_serves_what_is_in_a_bucket_and_a_database) {
  const Elsewhere elsewhere;
  const Daemon daemon(elsewhere.place().folder, {"--config", elsewhere.file()});
  const std::string id = publish_at(elsewhere.place(), "vase");
  const auto pmesh = tiny_pmesh("a base", "a chunk of vase");
  EXPECT_EQ(HttpClient(daemon.port()).get(file_of(id)).body,
            std::string(pmesh.bytes.begin(), pmesh.bytes.end()));
  const auto token =
      run_program({kVitrine, "token", "create", "--role", "viewer", "--data", elsewhere.file()});
  EXPECT_EQ(token.exit_code, 0) << token.errors;
  EXPECT_FALSE(std::filesystem::exists(elsewhere.place().folder / kCatalogueFile));
  EXPECT_FALSE(std::filesystem::exists(elsewhere.place().folder / "objects"));
}

TEST(Elsewhere, while_the_database_is_away_what_is_known_is_served_on) {
  const Elsewhere elsewhere;
  const std::string id = publish_at(elsewhere.place(), "vase");
  const std::string other = publish_at(elsewhere.place(), "bowl");
  Daemon daemon(elsewhere.place().folder, {"--config", elsewhere.file()});
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
  EXPECT_THAT(daemon.wait_for_line("the catalogue refuses"), HasSubstr("event=error"));
}

TEST(Elsewhere, no_secret_is_printed) {
  const Elsewhere elsewhere;
  const auto printed = run_vitrined({"--config", elsewhere.file(), "--print-config"});
  EXPECT_EQ(printed.exit_code, 0);
  EXPECT_THAT(printed.output, HasSubstr(elsewhere.place().store));
  EXPECT_THAT(printed.output, HasSubstr("# catalogue is not shown"));
  EXPECT_THAT(printed.output, Not(HasSubstr(kPostgresPassword)));
  EXPECT_THAT(printed.output, Not(HasSubstr(kGatewayKeys.secret)));
}

TEST(Elsewhere, a_start_with_a_wrong_secret_says_so) {
  const Elsewhere elsewhere;
  const auto ended = run_vitrined(
      {"--config", elsewhere.file(), "--listen", "127.0.0.1:0", "--store-secret-key", "another"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_THAT(ended.output, HasSubstr("403 SignatureDoesNotMatch; check store-access-key"));
}

TEST(Elsewhere, the_doctor_looks_at_both) {
  const Elsewhere elsewhere;
  publish_at(elsewhere.place(), "vase");
  const auto well = run_program({kVitrine, "doctor", "--data", elsewhere.file()});
  EXPECT_EQ(well.exit_code, 0) << well.output << well.errors;
  EXPECT_THAT(well.output, HasSubstr("lets us write, read, list and remove"));
  EXPECT_THAT(well.output, HasSubstr("1 models, their files are there"));
  const auto installation = open_installation(elsewhere.place()).value();
  ASSERT_TRUE(installation.store->remove(installation.catalogue->files().value().front().file));
  const auto ill = run_program({kVitrine, "doctor", "--data", elsewhere.file()});
  EXPECT_EQ(ill.exit_code, 1);
  EXPECT_THAT(ill.output, HasSubstr("1 of 1 models have lost their file"));
}

TEST(Elsewhere, the_command_migrates_an_installation) {
  const Elsewhere elsewhere;
  const TemporaryFolder folder;
  publish_at({.folder = folder.path()}, "vase");
  const auto moved = run_program(
      {kVitrine, "migrate", "--from", folder.path().string(), "--to", elsewhere.file(), "--json"});
  EXPECT_EQ(moved.exit_code, 0) << moved.errors;
  EXPECT_THAT(moved.output, HasSubstr("\"models\":1"));
  EXPECT_EQ(open_installation(elsewhere.place()).value().catalogue->files().value().size(), 1u);
}

}  // namespace
}  // namespace vitrine::test
