// SPDX-License-Identifier: Apache-2.0
// Tests find_faults(), which checks a PostgreSQL catalogue for damage.
#include "server/catalogue/find_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/catalogue/postgres.h"
#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/sql_catalogue.h"
#include "support/process/postgres_server.h"
#include "support/product_names.h"

namespace vitrine::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class PostgresFaults : public testing::Test {
 protected:
  PostgresFaults() {
    ModelRecord model;
    model.id = ModelId::generate();
    const ChunkPlace chunk{.chunk = Sha256{1}, .offset = 1, .length = 2};
    EXPECT_TRUE(make_catalogue(server::postgres::open_database(url_).value().database)
                    ->add(model, std::span(&chunk, 1)));
  }
  std::vector<std::string> faults_after(const char* sql) const {
    server::postgres::PostgresConnection(url_).run(sql);
    return server::postgres::find_faults(url_).value();
  }

  const std::string url_ = new_database();
};

TEST_F(PostgresFaults, AnIntactCatalogueHasNone) {
  EXPECT_THAT(faults_after("SELECT 1"), IsEmpty());
}

TEST_F(PostgresFaults, IndicesAreCheckedIfTheServerCanDoSo) {
  EXPECT_THAT(faults_after("CREATE EXTENSION amcheck"), IsEmpty());
  EXPECT_THAT(faults_after("CREATE OR REPLACE FUNCTION bt_index_check(index regclass) RETURNS void "
                           "LANGUAGE plpgsql AS 'BEGIN RAISE ''a torn page''; END'"),
              ElementsAre("an index: a torn page"));
}

TEST_F(PostgresFaults, IndicesOfNotesAreChecked) {
  EXPECT_THAT(faults_after("CREATE FUNCTION bt_index_check(index regclass) RETURNS void LANGUAGE "
                           "plpgsql AS 'BEGIN IF index = ''annotation_pkey''::regclass THEN "
                           "RAISE ''a torn page''; END IF; END'"),
              ElementsAre("an index: a torn page"));
}

TEST_F(PostgresFaults, ARowThatRefersToNoRowIsOne) {
  EXPECT_THAT(faults_after("SET session_replication_role = replica; DELETE FROM model"),
              ElementsAre("the table chunk: a row refers to a row that is missing from model"));
}

TEST_F(PostgresFaults, ANoteOfAMissingModelIsOne) {
  EXPECT_THAT(faults_after("SET session_replication_role = replica; "
                           "INSERT INTO annotation VALUES ('x', 0, 1, 1, '[]')"),
              ElementsAre("the table annotation: a row refers to a row that is missing from "
                          "model"));
}

TEST_F(PostgresFaults, ATableThatCannotBeReadIsOne) {
  EXPECT_THAT(faults_after("DROP TABLE scanner"), ElementsAre(HasSubstr("the table scanner: ")));
  EXPECT_THAT(faults_after("DROP TABLE annotation"), Contains(HasSubstr("the table annotation: ")));
}

}  // namespace
}  // namespace vitrine::test
