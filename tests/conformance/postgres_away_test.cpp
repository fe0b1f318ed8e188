// SPDX-License-Identifier: Apache-2.0
// Tests the cases that only a catalogue on a database server has: connection faults, a lock between
// processes, and tables of a newer version.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/sql_catalogue.h"
#include "support/process/postgres_server.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string fault(const std::string& url) {
  const auto database = postgres::open_database(url);
  return database ? "" : database.error().message;
}

std::string with(std::string url, const std::string& old, const std::string& fresh) {
  return url.replace(url.find(old), old.size(), fresh);
}

TEST(Postgres, CallsFailWhileTheServerIsStoppedAndSucceedAfterwards) {
  const std::string url = new_database();
  const auto catalogue = make_catalogue(postgres::open_database(url).value().database);
  ASSERT_TRUE(catalogue->add_token({.id = TokenId::generate(), .role = Role::kAdmin}));
  stop_postgres();
  const auto refused = catalogue->tokens();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_THAT(refused.error().message, HasSubstr("cannot use the catalogue: "));
  EXPECT_THAT(refused.error().message, Not(HasSubstr(kPostgresPassword)));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("\n")));
  EXPECT_THAT(fault(url), HasSubstr("Connection refused"));
  start_postgres();
  while (!catalogue->revision())
    std::this_thread::yield();
  EXPECT_EQ(catalogue->tokens().value().size(), 1u);
}

TEST(Postgres, ConnectionsThatARestartHasEndedAreNoFault) {
  const auto catalogue = make_catalogue(postgres::open_database(new_database()).value().database);
  ASSERT_TRUE(catalogue->revision());
  stop_postgres();
  start_postgres();
  EXPECT_TRUE(catalogue->revision());
}

TEST(Postgres, UsersOfAllConnectionsDelayNoUserOfASeparateOne) {
  const auto opened = postgres::open_database(new_database()).value();
  std::vector<std::shared_ptr<sql::DatabaseConnection>> held;
  for (int i = 0; i < 8; ++i)
    held.push_back(opened.database->lease());
  EXPECT_TRUE(make_catalogue(opened.separate)->tokens());
}

TEST(Postgres, AWrongPasswordIsReportedWithoutShowingIt) {
  const std::string told = fault(with(new_database(), kPostgresPassword, "not-the-secret"));
  EXPECT_THAT(told, HasSubstr("password authentication failed"));
  EXPECT_THAT(told, Not(HasSubstr("not-the-secret")));
}

TEST(Postgres, AFaultyUrlIsNotRepeated) {
  EXPECT_THAT(fault("postgresql://museum:pass%zzword@127.0.0.1/x"),
              HasSubstr("is not a PostgreSQL URL"));
}

TEST(Postgres, AMissingDatabaseIsReported) {
  EXPECT_THAT(fault(with(new_database(), "/database", "/nothing")), HasSubstr("does not exist"));
}

TEST(Postgres, OneAtATimeOfSeveralProcessesHoldsTheLock) {
  const std::string url = new_database();
  std::atomic<int> holding = 0;
  std::vector<std::thread> holders;
  for (int i = 0; i < 4; ++i) {
    holders.emplace_back([&url, &holding] {
      const auto database = postgres::open_database(url).value();
      for (int round = 0; round < 20; ++round) {
        const auto lock = database.lock();
        ASSERT_TRUE(lock);
        EXPECT_EQ(++holding, 1);
        --holding;
      }
    });
  }
  for (auto& holder : holders)
    holder.join();
}

TEST(Postgres, TheHolderFindsOutThatTheLockHasGoneToAnother) {
  const std::string url = new_database();
  const auto database = postgres::open_database(url).value();
  const auto lost = database.lock().value();
  EXPECT_TRUE(lost->check());
  const auto connection = database.database->lease();
  connection->run("SELECT pg_terminate_backend(pid) FROM pg_locks WHERE locktype = 'advisory'");
  const auto other = postgres::open_database(url).value().lock();
  ASSERT_TRUE(other);
  EXPECT_TRUE((*other)->check());
  const auto checked = lost->check();
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error().message, HasSubstr("the lock on the catalogue was lost"));
}

TEST(Postgres, TheHolderOfTheLockCanWorkHoweverManyWait) {
  const auto database = postgres::open_database(new_database()).value();
  const auto catalogue = make_catalogue(database.database);
  std::vector<std::thread> publishers;
  for (int i = 0; i < 20; ++i) {
    publishers.emplace_back([&] {
      const auto lock = database.lock();
      ASSERT_TRUE(lock);
      ModelRecord model;
      model.id = ModelId::generate();
      EXPECT_TRUE(catalogue->add(model, {}));
    });
  }
  for (auto& publisher : publishers)
    publisher.join();
  EXPECT_EQ(catalogue->search({.includes_drafts = true}).value().models.size(), 20u);
}

TEST(Postgres, SeveralThatStartAtOnceMakeTheTablesOnce) {
  const std::string url = new_database();
  std::vector<std::thread> starting;
  for (int i = 0; i < 4; ++i)
    starting.emplace_back([&url] { EXPECT_EQ(fault(url), ""); });
  for (auto& start : starting)
    start.join();
}

TEST(Postgres, AnOlderVersionContinuesWithNewerTablesThatAllowIt) {
  const std::string url = new_database();
  const auto database = postgres::open_database(url).value().database;
  database->lease()->run(
      "INSERT INTO migration(version) VALUES (1000); INSERT INTO compatible VALUES (1000, 3);"
      "ALTER TABLE model ADD COLUMN of_later TEXT NOT NULL DEFAULT ''");
  const auto catalogue = make_catalogue(postgres::open_database(url).value().database);
  ModelRecord model;
  model.id = ModelId::generate();
  EXPECT_TRUE(catalogue->add(model, {}));
  EXPECT_TRUE(make_catalogue(database)->find(model.id).value());
  database->lease()->run("UPDATE compatible SET since = 1000 WHERE version = 1000");
  EXPECT_THAT(fault(url), HasSubstr("newer version"));
}

}  // namespace
}  // namespace vitrine::test
