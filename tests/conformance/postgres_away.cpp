// SPDX-License-Identifier: Apache-2.0
// What a database on another machine does that a file does not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/sql_catalogue.h"
#include "support/postgres_server.h"

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

TEST(Postgres, while_the_server_is_away_all_is_refused_and_afterwards_it_goes_on) {
  const std::string url = new_database();
  const auto catalogue = make_catalogue(postgres::open_database(url).value().database);
  ASSERT_TRUE(catalogue->add_token({.id = ModelId::generate(), .role = Role::kAdmin}));
  stop_postgres();
  const auto refused = catalogue->tokens();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kIo);
  EXPECT_THAT(refused.error().message, HasSubstr("the catalogue refuses: "));
  EXPECT_THAT(refused.error().message, Not(HasSubstr(kPostgresPassword)));
  EXPECT_THAT(refused.error().message, Not(HasSubstr("\n")));
  EXPECT_THAT(fault(url), HasSubstr("Connection refused"));
  start_postgres();
  while (!catalogue->revision())
    std::this_thread::yield();
  EXPECT_EQ(catalogue->tokens().value().size(), 1u);
}

TEST(Postgres, connections_that_a_restart_has_ended_are_no_fault) {
  const auto catalogue = make_catalogue(postgres::open_database(new_database()).value().database);
  ASSERT_TRUE(catalogue->revision());
  stop_postgres();
  start_postgres();
  EXPECT_TRUE(catalogue->revision());
}

TEST(Postgres, a_wrong_password_is_told_and_not_shown) {
  const std::string told = fault(with(new_database(), kPostgresPassword, "not-the-secret"));
  EXPECT_THAT(told, HasSubstr("password authentication failed"));
  EXPECT_THAT(told, Not(HasSubstr("not-the-secret")));
}

TEST(Postgres, a_faulty_url_is_not_repeated) {
  EXPECT_THAT(fault("postgresql://museum:pass%zzword@127.0.0.1/x"),
              HasSubstr("is no URL of PostgreSQL"));
}

TEST(Postgres, a_database_that_is_missing_is_told) {
  EXPECT_THAT(fault(with(new_database(), "/database", "/nothing")), HasSubstr("does not exist"));
}

TEST(Postgres, one_at_a_time_of_several_processes_holds_the_lock) {
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

TEST(Postgres, who_holds_the_lock_is_told_once_the_server_has_given_it_to_another) {
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
  EXPECT_THAT(checked.error().message, HasSubstr("the catalogue's lock is lost"));
}

TEST(Postgres, who_holds_the_lock_works_on_whatever_the_number_of_those_that_wait) {
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
  EXPECT_EQ(catalogue->search({.drafts = true}).value().models.size(), 20u);
}

TEST(Postgres, several_that_start_at_once_make_the_tables_once) {
  const std::string url = new_database();
  std::vector<std::thread> starting;
  for (int i = 0; i < 4; ++i)
    starting.emplace_back([&url] { EXPECT_EQ(fault(url), ""); });
  for (auto& start : starting)
    start.join();
}

TEST(Postgres, an_older_version_goes_on_beside_the_tables_of_a_newer_one_that_says_so) {
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
