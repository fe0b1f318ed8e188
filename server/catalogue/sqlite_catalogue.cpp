// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sqlite_catalogue.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/catalogue/guarded_connection.h"

namespace vitrine {
namespace {

using sqlite::Database;
using sqlite::Statement;
using sqlite::Transaction;

constexpr std::string_view kColumns =
    "id, state, created, title, creator, rights, licence, unit, file, file_bytes, head_bytes, "
    "faces, vertices, more, accuracy, version, public_max_level, public_file, public_file_bytes, "
    "public_head_bytes, public_faces, public_vertices";

std::uint64_t count(const Statement& row, int column) {
  return static_cast<std::uint64_t>(row.integer(column));
}

std::map<std::string, std::string> read_more(const std::string& text) {
  std::map<std::string, std::string> more;
  const auto json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) return more;
  for (const auto& [name, value] : json.items()) {
    if (value.is_string()) more[name] = value.get<std::string>();
  }
  return more;
}

std::optional<PublicPart> read_public_part(const Statement& row) {
  if (row.is_null(16)) return std::nullopt;
  return PublicPart{.max_level = static_cast<std::uint32_t>(row.integer(16)),
                    .file = row.blob<32>(17),
                    .file_bytes = count(row, 18),
                    .head_bytes = count(row, 19),
                    .faces = count(row, 20),
                    .vertices = count(row, 21)};
}

ModelRecord read_model(const Statement& row) {
  ModelRecord model;
  model.id = ModelId::from_bytes(row.blob<16>(0));
  model.state = row.integer(1) == 1 ? ModelState::kPublished : ModelState::kDraft;
  model.created = row.integer(2);
  model.title = row.text(3);
  model.creator = row.text(4);
  model.rights = row.text(5);
  model.licence = row.text(6);
  model.unit = row.text(7);
  model.file = row.blob<32>(8);
  model.file_bytes = count(row, 9);
  model.head_bytes = count(row, 10);
  model.faces = count(row, 11);
  model.vertices = count(row, 12);
  model.more = read_more(row.text(13));
  if (!row.is_null(14)) model.accuracy = row.real(14);
  model.version = count(row, 15);
  model.public_part = read_public_part(row);
  return model;
}

std::int64_t number(std::uint64_t value) {
  return static_cast<std::int64_t>(value);
}

std::string more_text(const ModelRecord& model) {
  return nlohmann::json(model.more).dump();
}

void bind_public_part(Statement& row, const std::optional<PublicPart>& part) {
  if (!part) {
    for (int i = 0; i < 6; ++i)
      row.bind_null();
    return;
  }
  row.bind(number(part->max_level)).bind(part->file).bind(number(part->file_bytes));
  row.bind(number(part->head_bytes)).bind(number(part->faces)).bind(number(part->vertices));
}

void bind_model(Statement& row, const ModelRecord& m) {
  row.reset().bind(m.id.bytes()).bind(static_cast<std::int64_t>(m.state)).bind(m.created);
  row.bind(m.title).bind(m.creator).bind(m.rights).bind(m.licence).bind(m.unit).bind(m.file);
  row.bind(number(m.file_bytes)).bind(number(m.head_bytes));
  row.bind(number(m.faces)).bind(number(m.vertices)).bind(more_text(m));
  if (m.accuracy) {
    row.bind_real(*m.accuracy);
  } else {
    row.bind_null();
  }
  row.bind(number(m.version));
  bind_public_part(row, m.public_part);
}

TokenRecord read_token(const Statement& row) {
  return {.id = ModelId::from_bytes(row.blob<16>(0)),
          .role = static_cast<Role>(row.integer(1)),
          .hash = row.blob<32>(2),
          .label = row.text(3),
          .created = row.integer(4)};
}

// Words become patterns of LIKE in which the user's own % and _ mean themselves.
std::vector<std::string> patterns(std::string_view text) {
  constexpr std::size_t kMaxWords = 8;
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (c == '%' || c == '_' || c == '\\') word += '\\';
    if (c != ' ' && c != '\t') word += c;
    if ((c == ' ' || c == '\t') && !word.empty())
      words.push_back('%' + std::exchange(word, {}) + '%');
  }
  if (!word.empty()) words.push_back('%' + word + '%');
  words.resize(std::min(words.size(), kMaxWords));
  return words;
}

Unexpected changed_meanwhile(const ModelId& id) {
  return fail(
      ErrorCode::kState,
      fmt::format("model {} was changed or removed meanwhile; read it again", id.to_string()));
}

class SqliteCatalogue final : public Catalogue, private sqlite::GuardedConnection {
 public:
  explicit SqliteCatalogue(Database database)
      : GuardedConnection(std::move(database)),
        insert_model_(database_, fmt::format("INSERT INTO model({}) VALUES "
                                             "(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)",
                                             kColumns)),
        insert_chunk_(database_, "INSERT OR IGNORE INTO chunk VALUES (?,?,?,?)"),
        update_state_(
            database_,
            "UPDATE model SET state = ?2, version = version + 1 WHERE id = ?1 RETURNING 1"),
        update_model_(
            database_,
            "UPDATE model SET state = ?2, title = ?4, creator = ?5, rights = ?6, licence = ?7, "
            "unit = ?8, file = ?9, file_bytes = ?10, head_bytes = ?11, faces = ?12, "
            "vertices = ?13, more = ?14, accuracy = ?15, version = version + 1, "
            "public_max_level = ?17, public_file = ?18, public_file_bytes = ?19, "
            "public_head_bytes = ?20, public_faces = ?21, public_vertices = ?22 "
            "WHERE id = ?1 AND version = ?16 RETURNING 1"),
        remove_chunks_(database_, "DELETE FROM chunk WHERE model = ?"),
        remove_model_(
            database_,
            "DELETE FROM model WHERE id = ?1 AND version = ifnull(?2, version) RETURNING 1"),
        files_(database_,
               "SELECT id, file, file_bytes FROM model UNION ALL SELECT id, public_file, "
               "public_file_bytes FROM model WHERE public_file IS NOT NULL ORDER BY 1"),
        find_model_(database_, fmt::format("SELECT {} FROM model WHERE id = ?", kColumns)),
        find_same_(database_, fmt::format("SELECT {} FROM model WHERE state = 1 AND file = ? AND "
                                          "title = ? AND creator = ? AND rights = ? AND "
                                          "licence = ? AND more = ? ORDER BY id DESC LIMIT 1",
                                          kColumns)),
        find_chunk_(database_,
                    "SELECT model, offset, length FROM chunk JOIN model ON model.id = chunk.model "
                    "WHERE sha256 = ? AND state = 1 LIMIT 1"),
        insert_token_(database_,
                      "INSERT OR IGNORE INTO token(id, role, hash, label, created) "
                      "VALUES (?,?,?,?,?) RETURNING 1"),
        tokens_like_(database_,
                     "SELECT id, role, hash, label, created FROM token "
                     "WHERE prefix = ? AND revoked IS NULL"),
        tokens_(database_,
                "SELECT id, role, hash, label, created FROM token WHERE revoked IS NULL "
                "ORDER BY id"),
        revoke_token_(database_,
                      "UPDATE token SET revoked = unixepoch() * 1000 "
                      "WHERE id = ? AND revoked IS NULL RETURNING 1"),
        data_version_(database_, "PRAGMA data_version") {}

  Expected<void> add(const ModelRecord& model, std::span<const ChunkPlace> chunks) override {
    return guarded<void>([&]() -> Expected<void> {
      Transaction transaction(database_);
      if (find_model_.reset().bind(model.id.bytes()).step()) {
        find_model_.reset();
        return fail(ErrorCode::kState,
                    fmt::format("model {} exists; use another id", model.id.to_string()));
      }
      bind_model(insert_model_, model);
      insert_model_.step();
      insert_chunks(model.id, chunks);
      transaction.commit();
      ++own_changes_;
      return {};
    });
  }

  Expected<void> set_state(const ModelId& id, ModelState state) override {
    return guarded<void>([&]() -> Expected<void> {
      update_state_.reset().bind(id.bytes()).bind(static_cast<std::int64_t>(state));
      if (!update_state_.any()) {
        return fail(ErrorCode::kState,
                    fmt::format("there is no model {}; list the models", id.to_string()));
      }
      ++own_changes_;
      return {};
    });
  }

  Expected<void> update(const ModelRecord& model,
                        std::optional<std::span<const ChunkPlace>> chunks) override {
    return guarded<void>([&]() -> Expected<void> {
      Transaction transaction(database_);
      bind_model(update_model_, model);
      if (!update_model_.any()) return changed_meanwhile(model.id);
      if (chunks) {
        remove_chunks_.reset().bind(model.id.bytes()).any();
        insert_chunks(model.id, *chunks);
      }
      transaction.commit();
      ++own_changes_;
      return {};
    });
  }

  Expected<void> remove(const ModelId& id, std::optional<std::uint64_t> version) override {
    return guarded<void>([&]() -> Expected<void> {
      Transaction transaction(database_);
      remove_chunks_.reset().bind(id.bytes()).any();
      remove_model_.reset().bind(id.bytes());
      if (version) remove_model_.bind(number(*version));
      if (!remove_model_.any()) return changed_meanwhile(id);
      transaction.commit();
      ++own_changes_;
      return {};
    });
  }

  Expected<std::vector<NamedFile>> files() override {
    return guarded<std::vector<NamedFile>>([&]() -> Expected<std::vector<NamedFile>> {
      std::vector<NamedFile> files;
      files_.reset();
      while (files_.step())
        files.push_back(
            {ModelId::from_bytes(files_.blob<16>(0)), files_.blob<32>(1), count(files_, 2)});
      return files;
    });
  }

  Expected<std::optional<ModelRecord>> find(const ModelId& id) override {
    return guarded<std::optional<ModelRecord>>([&]() -> Expected<std::optional<ModelRecord>> {
      if (!find_model_.reset().bind(id.bytes()).step()) return std::nullopt;
      auto model = read_model(find_model_);
      find_model_.reset();
      return model;
    });
  }

  Expected<std::optional<ModelRecord>> find_same(const ModelRecord& like) override {
    return guarded<std::optional<ModelRecord>>([&]() -> Expected<std::optional<ModelRecord>> {
      find_same_.reset().bind(like.file).bind(like.title).bind(like.creator);
      find_same_.bind(like.rights).bind(like.licence).bind(more_text(like));
      if (!find_same_.step()) return std::nullopt;
      auto model = read_model(find_same_);
      find_same_.reset();
      return model;
    });
  }

  Expected<ModelPage> search(const ModelQuery& query) override {
    return guarded<ModelPage>([&]() -> Expected<ModelPage> { return search_locked(query); });
  }

  Expected<std::optional<ChunkLocation>> find_chunk(const Sha256& chunk) override {
    return guarded<std::optional<ChunkLocation>>([&]() -> Expected<std::optional<ChunkLocation>> {
      if (!find_chunk_.reset().bind(chunk).step()) return std::nullopt;
      ChunkLocation location{ModelId::from_bytes(find_chunk_.blob<16>(0)),
                             {chunk, static_cast<std::uint64_t>(find_chunk_.integer(1)),
                              static_cast<std::uint64_t>(find_chunk_.integer(2))}};
      find_chunk_.reset();
      return location;
    });
  }

  Expected<void> add_token(const TokenRecord& token) override {
    return guarded<void>([&]() -> Expected<void> {
      insert_token_.reset().bind(token.id.bytes()).bind(static_cast<std::int64_t>(token.role));
      insert_token_.bind(token.hash).bind(token.label).bind(token.created);
      if (!insert_token_.any()) {
        return fail(ErrorCode::kState,
                    fmt::format("token {} exists; create another", token.id.to_string()));
      }
      return {};
    });
  }

  Expected<std::vector<TokenRecord>> tokens_like(const Sha256& hash) override {
    return guarded<std::vector<TokenRecord>>([&]() -> Expected<std::vector<TokenRecord>> {
      tokens_like_.reset().bind(std::span(hash).first<4>());
      std::vector<TokenRecord> tokens;
      while (tokens_like_.step())
        tokens.push_back(read_token(tokens_like_));
      return tokens;
    });
  }

  Expected<std::vector<TokenRecord>> tokens() override {
    return guarded<std::vector<TokenRecord>>([&]() -> Expected<std::vector<TokenRecord>> {
      std::vector<TokenRecord> tokens;
      tokens_.reset();
      while (tokens_.step())
        tokens.push_back(read_token(tokens_));
      return tokens;
    });
  }

  Expected<void> revoke_token(const ModelId& id) override {
    return guarded<void>([&]() -> Expected<void> {
      if (!revoke_token_.reset().bind(id.bytes()).any()) {
        return fail(ErrorCode::kState,
                    fmt::format("there is no token {} in force; check the id", id.to_string()));
      }
      return {};
    });
  }

  Expected<std::uint64_t> revision() override {
    return guarded<std::uint64_t>([&]() -> Expected<std::uint64_t> {
      data_version_.reset().step();
      const auto others = static_cast<std::uint64_t>(data_version_.integer(0));
      data_version_.reset();
      return others + (own_changes_ << 32);
    });
  }

 private:
  void insert_chunks(const ModelId& model, std::span<const ChunkPlace> chunks) {
    for (const ChunkPlace& c : chunks) {
      insert_chunk_.reset().bind(c.chunk).bind(model.bytes());
      insert_chunk_.bind(number(c.offset)).bind(number(c.length)).step();
    }
  }

  ModelPage search_locked(const ModelQuery& query) {
    const auto words = patterns(query.text);
    std::string sql = fmt::format("SELECT {} FROM model WHERE state >= ?", kColumns);
    if (query.after) sql += " AND id < ?";
    for (std::size_t i = 0; i < words.size(); ++i)
      sql += " AND title||' '||creator LIKE ? ESCAPE '\\'";
    sql += " ORDER BY id DESC LIMIT ?";

    Statement rows(database_, sql);
    rows.bind(query.drafts ? 0 : 1);
    if (query.after) rows.bind(query.after->bytes());
    for (const std::string& word : words)
      rows.bind(word);
    const std::uint32_t limit = std::clamp(query.limit, 1u, kMaxPage);
    rows.bind(limit + 1);  // one more tells whether there is a next page

    ModelPage page;
    while (rows.step())
      page.models.push_back(read_model(rows));
    if (page.models.size() > limit) {
      page.models.pop_back();
      page.next = page.models.back().id;
    }
    return page;
  }

  Statement insert_model_, insert_chunk_, update_state_, update_model_, remove_chunks_,
      remove_model_, files_, find_model_, find_same_, find_chunk_, insert_token_, tokens_like_,
      tokens_, revoke_token_, data_version_;
  std::uint64_t own_changes_ = 0;  // `PRAGMA data_version` counts the changes of others only
};

}  // namespace

Expected<std::unique_ptr<Catalogue>> open_sqlite_catalogue(const std::filesystem::path& file) {
  auto database = sqlite::open_database(file);
  if (!database) return Unexpected(database.error());
  return std::make_unique<SqliteCatalogue>(std::move(*database));
}

}  // namespace vitrine
