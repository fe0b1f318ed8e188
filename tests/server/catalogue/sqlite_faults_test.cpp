// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/find_faults.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "server/catalogue/sqlite.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class SqliteFaults : public testing::Test {
 protected:
  SqliteFaults() {
    const auto catalogue = open_sqlite_catalogue(file_).value();
    ModelRecord model;
    for (std::uint8_t i = 0; i < 100; ++i) {
      model.id = ModelId::generate();
      model.title = std::string(200, 'a');
      const ChunkPlace chunk{.chunk = Sha256{i}, .offset = 1, .length = 2};
      EXPECT_TRUE(catalogue->add(model, std::span(&chunk, 1)));
    }
  }
  std::vector<std::string> faults() const { return sqlite::find_faults(file_).value(); }

  // Returns the number of unused pages. Damage to them has no effect.
  std::size_t free_pages() const {
    const sqlite::SqliteHandle database(file_.string());
    sqlite::SqliteStatement row(database, "PRAGMA freelist_count");
    row.step();
    return static_cast<std::size_t>(row.integer(0));
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "catalogue.sqlite";
};

TEST_F(SqliteFaults, AnIntactCatalogueHasNone) {
  EXPECT_THAT(faults(), IsEmpty());
}

TEST_F(SqliteFaults, ADamagedPageIsOne) {
  const auto pages = std::filesystem::file_size(file_) / 4096;
  std::size_t found = 0;
  for (std::uintmax_t page = 1; page < pages; ++page) {
    const auto copy = folder_.path() / "copy";
    std::filesystem::copy_file(file_, copy, std::filesystem::copy_options::overwrite_existing);
    std::fstream(copy, std::ios::in | std::ios::out | std::ios::binary)
        .seekp(static_cast<std::streamoff>(page * 4096))
        .write(std::string(64, '\x7f').c_str(), 64);
    const auto faults = sqlite::find_faults(copy);
    ASSERT_TRUE(faults);
    found += faults->empty() ? 0 : 1;
    for (const std::string& fault : *faults)
      EXPECT_THAT(fault, Not(HasSubstr("\n")));
  }
  EXPECT_GE(found + free_pages(), pages - 1);
}

TEST_F(SqliteFaults, AFileThatIsNoDatabaseIsOne) {
  std::ofstream(file_) << std::string(8192, 'x');
  EXPECT_THAT(faults(), ElementsAre(HasSubstr("not a database")));
}

TEST_F(SqliteFaults, ARowThatRefersToNoRowIsOne) {
  sqlite::SqliteHandle(file_.string())
      .run("PRAGMA foreign_keys = OFF; DELETE FROM model WHERE id = (SELECT min(id) FROM model)");
  EXPECT_THAT(faults(), ElementsAre("a row of the table chunk refers to a row that is missing "
                                    "from model"));
}

TEST_F(SqliteFaults, ANoteOfAMissingModelIsOne) {
  sqlite::SqliteHandle(file_.string())
      .run("PRAGMA foreign_keys = OFF; INSERT INTO annotation VALUES (x'01', 0, 1, 1, '[]')");
  EXPECT_THAT(faults(), ElementsAre("a row of the table annotation refers to a row that is "
                                    "missing from model"));
}

TEST_F(SqliteFaults, AMissingIndexOfNotesIsOne) {
  sqlite::SqliteHandle(file_.string()).run("DROP INDEX annotation_guard");
  EXPECT_THAT(faults(), ElementsAre("the index annotation_guard is missing or changed"));
}

}  // namespace
}  // namespace vitrine::server
