// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_catalogue.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sql_model.h"
#include "server/catalogue/sql_search.h"

namespace vitrine::server {
namespace {

using sql::count;
using sql::DatabaseConnection;
using sql::number;
using sql::ScopedStatement;
using sql::Statement;
using sql::Transaction;

TokenRecord read_token(const Statement& row) {
  return {.id = TokenId::from_bytes(row.blob<16>(0)),
          .role = sql::checked(row.integer(1), Role::kAdmin),
          .hash = row.blob<32>(2),
          .label = row.text(3),
          .created = row.integer(4)};
}

Unexpected changed_meanwhile(const ModelId& id) {
  return fail(
      ErrorCode::kState,
      fmt::format("model {} was changed or removed meanwhile; read it again", id.to_string()));
}

std::int64_t now_in_milliseconds() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

const std::string kInsertModel = fmt::format(
    "INSERT INTO model({}) VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?) "
    "ON CONFLICT DO NOTHING RETURNING 1",
    kModelColumns);
const std::string kInsertChunk =
    "INSERT INTO chunk(sha256, model, \"offset\", length) VALUES (?,?,?,?) ON CONFLICT DO NOTHING";
const std::string kUpdateState =
    "UPDATE model SET state = ?2, version = version + 1 WHERE id = ?1 RETURNING 1";
const std::string kUpdateModel =
    "UPDATE model SET state = ?2, title = ?4, creator = ?5, rights = ?6, "
    "licence = ?7, unit = ?8, file = ?9, file_bytes = ?10, head_bytes = ?11, faces = ?12, "
    "vertices = ?13, more = ?14, accuracy = ?15, version = version + 1, "
    "public_max_level = ?17, public_file = ?18, public_file_bytes = ?19, "
    "public_head_bytes = ?20, public_faces = ?21, public_vertices = ?22, "
    "texture_count = ?23, texture_side = ?24, texture_bytes = ?25, public_texture_count = ?26, "
    "public_texture_side = ?27, public_texture_bytes = ?28, repairs = ?29, presentation = ?30 "
    "WHERE id = ?1 AND version = ?16 RETURNING 1";
const std::string kHoldJob =
    "UPDATE job SET model = ?3 WHERE id = ?1 AND fence = ?2 AND state = 1 RETURNING 1";
const std::string kStampChange = "UPDATE model_index SET state = state WHERE model = ?";
const std::string kRemoveChunks = "DELETE FROM chunk WHERE model = ?";
const std::string kRemoveModel =
    "DELETE FROM model WHERE id = ?1 AND version = coalesce(?2, version) RETURNING 1";
const std::string kFiles =
    "SELECT id, file, file_bytes FROM model UNION ALL SELECT id, public_file, "
    "public_file_bytes FROM model WHERE public_file IS NOT NULL ORDER BY 1";
const std::string kFindModel = select_models("id = ?");
const std::string kFindSame = select_models(
    "state = 1 AND file = ? AND title = ? AND creator = ? AND rights = ? AND licence = ? "
    "AND more = ? ORDER BY id DESC LIMIT 1");
const std::string kFindChunk =
    "SELECT model, \"offset\", length FROM chunk JOIN model ON model.id = chunk.model "
    "WHERE sha256 = ? AND chunk.model > ? AND state = 1 ORDER BY chunk.model LIMIT 1";
const std::string kPageCursors =
    "SELECT id FROM (SELECT id, row_number() OVER (ORDER BY id DESC) AS place, "
    "count(*) OVER () AS models FROM model WHERE state = 1) AS listed "
    "WHERE place % ? = 0 AND place < models ORDER BY id DESC";
const std::string kPublicChunks =
    "SELECT sha256 FROM chunk JOIN model ON model.id = chunk.model WHERE model = ? AND state = 1";
const std::string kInsertToken =
    "INSERT INTO token(id, role, hash, label, created) VALUES (?,?,?,?,?) "
    "ON CONFLICT DO NOTHING RETURNING 1";
const std::string kTokensLike =
    "SELECT id, role, hash, label, created FROM token WHERE prefix = ? AND revoked IS NULL";
const std::string kTokens =
    "SELECT id, role, hash, label, created FROM token WHERE revoked IS NULL ORDER BY id";
const std::string kRevokeToken =
    "UPDATE token SET revoked = ? WHERE id = ? AND revoked IS NULL RETURNING 1";

// Stores `model` in the job's record. The job's row stays locked until the transaction ends, so
// that no other daemon claims the job. Fails with kState if another daemon has already claimed it.
Expected<void> hold_job(DatabaseConnection& connection, const std::optional<JobClaim>& by,
                        const ModelId& model) {
  if (!by) return {};
  const ScopedStatement row(connection.prepare(kHoldJob));
  if (row->bind(by->job.bytes()).bind(number(by->fence)).bind(model.bytes()).any()) return {};
  return fail(
      ErrorCode::kState,
      fmt::format("another daemon has claimed or ended job {}, and its model; reload the job",
                  by->job.to_string()));
}

void insert_chunks(DatabaseConnection& connection, const ModelId& model,
                   std::span<const ChunkPlace> chunks) {
  for (const ChunkPlace& c : chunks) {
    const ScopedStatement row(connection.prepare(kInsertChunk));
    row->bind(c.chunk).bind(model.bytes()).bind(number(c.offset)).bind(number(c.length)).step();
  }
}

// Sets the time of the model's last change to now, through a trigger of the table `model_index`.
// Call this right before a transaction is committed. A harvester that reads the catalogue before
// the commit does not see the change, and would always miss the change if the recorded time were
// much earlier than the commit.
void stamp_change(DatabaseConnection& connection, const ModelId& model) {
  const ScopedStatement row(connection.prepare(kStampChange));
  row->bind(model.bytes()).any();
}

std::optional<ModelRecord> read_one(Statement& row) {
  return row.step() ? std::optional(read_model(row)) : std::nullopt;
}

std::vector<TokenRecord> read_tokens(Statement& rows) {
  std::vector<TokenRecord> tokens;
  while (rows.step())
    tokens.push_back(read_token(rows));
  return tokens;
}

std::vector<Sha256> read_public_chunks(DatabaseConnection& connection, const ModelId& model) {
  std::vector<Sha256> chunks;
  const ScopedStatement rows(connection.prepare(kPublicChunks));
  for (rows->bind(model.bytes()); rows->step();)
    chunks.push_back(rows->blob<32>(0));
  return chunks;
}

class SqlCatalogue final : public Catalogue {
 public:
  explicit SqlCatalogue(std::shared_ptr<sql::Database> database) : database_(std::move(database)) {}

  Expected<void> add(const ModelRecord& model, std::span<const ChunkPlace> chunks,
                     const std::optional<JobClaim>& by) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      Transaction transaction(connection);
      if (auto held = hold_job(connection, by, model.id); !held) return held;
      const ScopedStatement row(connection.prepare(kInsertModel));
      bind_model(*row, model);
      if (!row->any()) {
        return fail(ErrorCode::kState,
                    fmt::format("model {} exists; use another id", model.id.to_string()));
      }
      insert_chunks(connection, model.id, chunks);
      stamp_change(connection, model.id);
      transaction.commit();
      return {};
    });
  }

  Expected<void> set_state(const ModelId& id, ModelState state) override {
    const bool hides = state == ModelState::kDraft;
    return change(id, hides, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(connection.prepare(kUpdateState));
      if (row->bind(id.bytes()).bind(static_cast<std::int64_t>(state)).any()) return {};
      return fail(
          ErrorCode::kState,
          fmt::format("there is no model {}; list the models to find its ID", id.to_string()));
    });
  }

  Expected<void> update(const ModelRecord& model, std::optional<std::span<const ChunkPlace>> chunks,
                        const std::optional<JobClaim>& by) override {
    const bool hides = chunks || model.state == ModelState::kDraft;
    return change(model.id, hides, [&](DatabaseConnection& connection) -> Expected<void> {
      Transaction transaction(connection);
      if (auto held = hold_job(connection, by, model.id); !held) return held;
      const ScopedStatement row(connection.prepare(kUpdateModel));
      bind_model(*row, model);
      if (!row->any()) return changed_meanwhile(model.id);
      if (chunks) {
        const ScopedStatement old(connection.prepare(kRemoveChunks));
        old->bind(model.id.bytes()).any();
        insert_chunks(connection, model.id, *chunks);
      }
      stamp_change(connection, model.id);
      transaction.commit();
      return {};
    });
  }

  // The database also removes the model's chunks, because of their foreign key.
  Expected<void> remove(const ModelId& id, std::optional<std::uint64_t> version) override {
    return change(id, true, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(connection.prepare(kRemoveModel));
      row->bind(id.bytes());
      if (version) row->bind(number(*version));
      if (!row->any()) return changed_meanwhile(id);
      return {};
    });
  }

  Expected<std::vector<NamedFile>> files() override {
    using Files = std::vector<NamedFile>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Files> {
      Files files;
      const ScopedStatement rows(connection.prepare(kFiles));
      while (rows->step())
        files.push_back(
            {ModelId::from_bytes(rows->blob<16>(0)), rows->blob<32>(1), count(*rows, 2)});
      return files;
    });
  }

  Expected<std::optional<ModelRecord>> find(const ModelId& id) override {
    using Found = std::optional<ModelRecord>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Found> {
      const ScopedStatement row(connection.prepare(kFindModel));
      return read_one(row->bind(id.bytes()));
    });
  }

  Expected<std::optional<ModelRecord>> find_same(const ModelRecord& like) override {
    using Found = std::optional<ModelRecord>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Found> {
      const ScopedStatement row(connection.prepare(kFindSame));
      row->bind(like.file).bind(like.title).bind(like.creator).bind(like.rights);
      return read_one(row->bind(like.licence).bind(more_text(like)));
    });
  }

  Expected<ModelPage> search(const ModelQuery& query) override {
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<ModelPage> {
                                  return search_models(connection, query);
                                });
  }

  Expected<Facets> facets(const ModelQuery& query) override {
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<Facets> {
                                  return count_facets(connection, query);
                                });
  }

  Expected<Harvest> harvest(const HarvestQuery& query) override {
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<Harvest> {
                                  return harvest_models(connection, query);
                                });
  }

  Expected<std::vector<std::string>> collections() override {
    using Names = std::vector<std::string>;
    return sql::with_connection(*database_, [](DatabaseConnection& connection) -> Expected<Names> {
      return list_collections(connection);
    });
  }

  Expected<std::optional<ChunkLocation>> find_chunk_after(const Sha256& chunk,
                                                          const ModelId& after) override {
    using Found = std::optional<ChunkLocation>;
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<Found> {
      const ScopedStatement row(connection.prepare(kFindChunk));
      if (!row->bind(chunk).bind(after.bytes()).step()) return std::nullopt;
      return ChunkLocation{ModelId::from_bytes(row->blob<16>(0)),
                           {chunk, count(*row, 1), count(*row, 2)}};
    });
  }

  Expected<std::vector<ModelId>> page_cursors(std::uint32_t size) override {
    using Cursors = std::vector<ModelId>;
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<Cursors> {
                                  const ScopedStatement rows(connection.prepare(kPageCursors));
                                  rows->bind(std::int64_t{std::max(size, 1u)});
                                  Cursors cursors;
                                  while (rows->step())
                                    cursors.push_back(ModelId::from_bytes(rows->blob<16>(0)));
                                  return cursors;
                                });
  }

  Expected<std::vector<Sha256>> public_chunks(const ModelId& id) override {
    using Chunks = std::vector<Sha256>;
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<Chunks> {
                                  return read_public_chunks(connection, id);
                                });
  }

  Expected<void> add_token(const TokenRecord& token) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(connection.prepare(kInsertToken));
      row->bind(token.id.bytes()).bind(static_cast<std::int64_t>(token.role)).bind(token.hash);
      if (row->bind(token.label).bind(token.created).any()) return {};
      return fail(ErrorCode::kState,
                  fmt::format("token {} exists; create another", token.id.to_string()));
    });
  }

  Expected<std::vector<TokenRecord>> tokens_like(const Sha256& hash) override {
    using Tokens = std::vector<TokenRecord>;
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<Tokens> {
                                  const ScopedStatement rows(connection.prepare(kTokensLike));
                                  return read_tokens(rows->bind(std::span(hash).first<4>()));
                                });
  }

  Expected<std::vector<TokenRecord>> tokens() override {
    using Tokens = std::vector<TokenRecord>;
    return sql::with_connection(*database_,
                                [&](DatabaseConnection& connection) -> Expected<Tokens> {
                                  const ScopedStatement rows(connection.prepare(kTokens));
                                  return read_tokens(*rows);
                                });
  }

  Expected<void> revoke_token(const TokenId& id) override {
    return sql::with_connection(*database_, [&](DatabaseConnection& connection) -> Expected<void> {
      const ScopedStatement row(connection.prepare(kRevokeToken));
      if (row->bind(now_in_milliseconds()).bind(id.bytes()).any()) return {};
      return fail(ErrorCode::kState,
                  fmt::format("there is no token {} in force; check the id", id.to_string()));
    });
  }

  Expected<std::uint64_t> revision() override {
    return sql::with_connection(*database_,
                                [](DatabaseConnection& connection) -> Expected<std::uint64_t> {
                                  return connection.revision();
                                });
  }

  void when_hidden(ChunksHidden hidden) override { hidden_ = std::move(hidden); }

 private:
  // Runs `action` on a connection. If it succeeds and `hides` is true, calls the function set by
  // when_hidden() with the chunks that the model had. Releases the connection before that call.
  template <class Action>
  Expected<void> change(const ModelId& id, bool hides, const Action& action) {
    std::vector<Sha256> chunks;
    const auto run = [&](DatabaseConnection& connection) -> Expected<void> {
      if (hides && hidden_) chunks = read_public_chunks(connection, id);
      return action(connection);
    };
    auto done = sql::with_connection(*database_, run);
    if (done && !chunks.empty()) hidden_(std::move(chunks));
    return done;
  }

  const std::shared_ptr<sql::Database> database_;
  ChunksHidden hidden_;
};

}  // namespace

std::unique_ptr<Catalogue> make_catalogue(std::shared_ptr<sql::Database> database) {
  return std::make_unique<SqlCatalogue>(std::move(database));
}

}  // namespace vitrine::server
