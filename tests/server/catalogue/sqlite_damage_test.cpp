// SPDX-License-Identifier: Apache-2.0
// Damages a small catalogue page by page. The damage must be found, or must not have changed any
// stored content. No function of the catalogue may crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "server/catalogue/find_faults.h"
#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sqlite.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "server/catalogue/sqlite_database.h"
#include "support/seeds.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kPageBytes = 4096;
constexpr std::uint64_t kFlipsPerPage = 12;

// SQL queries for all content of the catalogue, except the progress of running jobs and scanners.
constexpr const char* kContents[] = {
    ("SELECT quote(id)||state||'|'||created||'|'||quote(title)||quote(creator)||quote(rights)||"
     "quote(licence)||quote(unit)||quote(file)||file_bytes||'|'||head_bytes||'|'||faces||'|'||"
     "vertices||quote(more)||quote(accuracy)||version||'|'||quote(public_max_level)||"
     "quote(public_file)||quote(public_file_bytes)||quote(public_head_bytes)||quote(public_faces)||"
     "quote(public_vertices)||texture_count||'|'||texture_side||'|'||texture_bytes||'|'||"
     "public_texture_count||'|'||public_texture_side||'|'||public_texture_bytes||'|'||"
     "quote(repairs) "
     "FROM model NOT INDEXED ORDER BY 1"),
    ("SELECT quote(sha256)||quote(model)||offset||'|'||length FROM chunk NOT INDEXED ORDER BY 1"),
    ("SELECT quote(id)||kind||'|'||state||quote(scanner)||quote(scan)||quote(model)||quote(error)||"
     "quote(parameters)||created||'|'||ended||quote(webhook)||attempts||'|'||told||'|'||fence||'|'|"
     "|"
     "cancelled||quote(repairs)||quote(owner) FROM job NOT INDEXED ORDER BY 1"),
    ("SELECT "
     "quote(id)||quote(job)||quote(scanner)||public||quote(title)||quote(parameters)||steps||"
     "'|'||step||'|'||points||'|'||calibration||quote(model)||created||quote(empty_rows)||"
     "quote(saturated_rows)||quote(doubled_rows)||quote(turn)||quote(built) "
     "FROM scan NOT INDEXED ORDER BY 1"),
    ("SELECT quote(key)||quote(request)||quote(job) FROM idempotency NOT INDEXED ORDER BY 1"),
    ("SELECT quote(id)||role||quote(hash)||quote(label)||created||quote(revoked) "
     "FROM token NOT INDEXED ORDER BY 1"),
    ("SELECT quote(model)||day||'|'||visits||'|'||seconds||'|'||levels||'|'||complete "
     "FROM visit NOT INDEXED ORDER BY 1")};

std::string contents_of(const std::filesystem::path& file) {
  std::string all;
  const sqlite::SqliteHandle database(file.string());
  for (const char* sql : kContents) {
    for (sqlite::SqliteStatement row(database, sql); row.step();)
      all += row.text(0) + '\n';
  }
  return all;
}

class SqliteDamage : public testing::Test {
 protected:
  SqliteDamage() {
    fill();
    contents_ = contents_of(file_);
    std::ifstream in(file_, std::ios::binary);
    bytes_ = {std::istreambuf_iterator<char>(in), {}};
  }

  std::size_t pages() const { return bytes_.size() / kPageBytes; }

  // Writes a damaged copy. Expects that the damage is found, or has changed no content.
  void expect_found_or_harmless(const std::string& damaged) {
    write(damaged);
    const auto faults = sqlite::find_faults(copy_);
    if (faults && faults->empty()) {
      try {
        EXPECT_EQ(contents_of(copy_), contents_);
      } catch (const sql::Failure& failure) {
        ADD_FAILURE() << "damage that is not found: " << failure.what();
      }
      ++harmless_;
    }
    write(damaged);
    use();
  }

  // Expects that the catalogue refuses to open, and tells the operator to restore a backup.
  void expect_refusal(const std::string& damaged) {
    write(damaged);
    const auto opened = open_sqlite_catalogue(copy_);
    ASSERT_FALSE(opened);
    EXPECT_THAT(opened.error().message, testing::HasSubstr("restore a backup with"));
  }

  test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "catalogue.sqlite",
                              copy_ = folder_.path() / "copy.sqlite";
  std::string contents_, bytes_;
  std::size_t harmless_ = 0;  // number of copies with damage that changed no content

 private:
  // Adds rows to all tables.
  void fill() const {
    const auto catalogue = open_sqlite_catalogue(file_).value();
    const auto jobs = open_sqlite_jobs(file_).value();
    const auto visits = make_visits(sqlite::open_database(file_).value());
    const auto notes = make_notes(sqlite::open_database(file_).value());
    for (std::uint8_t i = 0; i < 20; ++i) {
      ModelRecord model{.id = ModelId::generate(), .state = ModelState::kPublished};
      model.created = 1'700'000'000'000 + i;
      model.title = "Bust " + std::to_string(i);
      model.more = {{"subject", "portraits"}};
      model.repairs = "1 duplicate face dropped";
      model.file = Sha256{i, 1};
      if (i % 2 == 0) model.public_part = PublicPart{.max_level = 3, .file = Sha256{i, 2}};
      const ChunkPlace chunks[] = {{.chunk = Sha256{i, 3}, .offset = 100, .length = 2'000},
                                   {.chunk = Sha256{i, 4}, .offset = 2'100, .length = 3'000}};
      EXPECT_TRUE(catalogue->add(model, chunks));
      const NoteSheet sheet{.entries = 1, .text = R"([{"id":"ear"}])"};
      EXPECT_TRUE(notes->put(model.id, static_cast<NoteKind>(i % 2), sheet));
      const ModelDay day{model.id, std::chrono::sys_days(std::chrono::days(20'000 + i))};
      EXPECT_TRUE(visits->add({{day, {.visits = 3u + i, .seconds = 90, .levels = 7}}}));
      const TokenRecord token{.id = TokenId::generate(),
                              .role = static_cast<Role>(1 + i % 3),
                              .hash = Sha256{i, 5},
                              .label = "desk",
                              .created = model.created};
      EXPECT_TRUE(catalogue->add_token(token));
      EXPECT_TRUE(i % 4 > 0 || catalogue->revoke_token(token.id));
      const JobRecord job{.id = JobId::generate(),
                          .kind = static_cast<JobKind>(i % 4),
                          .state = static_cast<JobState>(i % 6),
                          .scanner = "left",
                          .parameters = R"({"title":"Bust"})",
                          .created = model.created,
                          .owner = token.id.to_string()};
      const ScanEntry scan{.id = ScanId::generate(), .job = job.id, .title = "Bust", .steps = 720};
      EXPECT_TRUE(jobs->add(job, scan, IdempotencyKey{"key " + std::to_string(i), Sha256{i, 6}}));
    }
  }

  void write(const std::string& damaged) const {
    for (const char* suffix : {"", "-wal", "-shm"})
      std::filesystem::remove(copy_.string() + suffix);
    std::ofstream(copy_, std::ios::binary) << damaged;
  }

  // Calls the functions that the daemon calls. They may fail, but must not crash or throw.
  void use() const {
    const auto catalogue = open_sqlite_catalogue(copy_);
    const auto jobs = open_sqlite_jobs(copy_);
    if (!catalogue || !jobs) return;
    static_cast<void>((*catalogue)->search({.text = "bust", .includes_drafts = true}));
    static_cast<void>((*catalogue)->files());
    static_cast<void>((*catalogue)->tokens());
    static_cast<void>((*catalogue)->tokens_like(Sha256{1, 5}));
    static_cast<void>((*catalogue)->find_chunk(Sha256{1, 3}));
    static_cast<void>((*catalogue)->revision());
    static_cast<void>((*jobs)->jobs({}));
    static_cast<void>((*jobs)->scans({}));
    static_cast<void>((*jobs)->count_jobs());
    static_cast<void>((*jobs)->unfinished_jobs());
    static_cast<void>((*jobs)->find_key("key 1"));
    static_cast<void>((*jobs)->waiting_jobs(std::array{JobKind::kPublish}, 10, true));
    static_cast<void>((*catalogue)->add_token({.id = TokenId::generate(), .hash = Sha256{99}}));
  }
};

TEST_F(SqliteDamage, AFlippedBitIsFoundOrChangesNoContent) {
  const auto seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const std::uint64_t flips = test::seeds(kFlipsPerPage);
  for (std::size_t page = 0; page < pages(); ++page) {
    for (std::uint64_t flip = 0; flip < flips && !HasFailure();) {
      const std::size_t at = page * kPageBytes + random() % kPageBytes;
      if (bytes_[at] == 0 && random() % 8 > 0) continue;  // most zero bytes are unused
      ++flip;
      const unsigned bit = random() % 8;
      SCOPED_TRACE("bit " + std::to_string(bit) + " of byte " + std::to_string(at));
      std::string damaged = bytes_;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << bit));
      expect_found_or_harmless(damaged);
    }
  }
}

// A model's title and a token's hash are stored twice: in a table and in an index. A change of
// either copy must be found.
TEST_F(SqliteDamage, AFlippedBitInAValueIsFound) {
  const std::string hash = {7, 5};  // first bytes of the hash of token 7, which fill() adds
  for (const std::string& value : {std::string("Bust 7"), hash + std::string(30, '\0')}) {
    const auto first = bytes_.find(value);
    ASSERT_NE(first, bytes_.npos);
    ASSERT_NE(bytes_.find(value, first + 1), bytes_.npos);
    for (auto at = first; at != bytes_.npos; at = bytes_.find(value, at + 1)) {
      SCOPED_TRACE("byte " + std::to_string(at));
      std::string damaged = bytes_;
      damaged[at + 1] = static_cast<char>(damaged[at + 1] ^ 4);
      expect_found_or_harmless(damaged);
    }
  }
  EXPECT_EQ(harmless_, 0u);
}

TEST_F(SqliteDamage, AZeroedPageIsFound) {
  for (std::size_t page = 0; page < pages(); ++page) {
    SCOPED_TRACE("page " + std::to_string(page));
    expect_found_or_harmless(
        std::string(bytes_).replace(page * kPageBytes, kPageBytes, kPageBytes, '\0'));
  }
  EXPECT_EQ(harmless_, 0u);
}

TEST_F(SqliteDamage, ADamagedCatalogueSaysWhatToDo) {
  expect_refusal("no database, but long enough to be one" + std::string(kPageBytes, ' '));
  const auto schema = bytes_.find("CREATE TABLE model");
  ASSERT_NE(schema, bytes_.npos);
  expect_refusal(std::string(bytes_).replace(schema, 6, "CREVTE"));
}

}  // namespace
}  // namespace vitrine::server
