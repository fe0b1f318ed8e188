// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/sql_search.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "server/catalogue/sql_model.h"

namespace vitrine::server {
namespace {

using sql::DatabaseConnection;
using sql::ScopedStatement;
using sql::Statement;

bool separates_words(unsigned char c) {
  return c <= ' ' || (c < 0x80 && std::ispunct(c) != 0);
}

// Returns the first eight words of `text`. ASCII punctuation separates words.
std::vector<std::string> words_of(std::string_view text) {
  constexpr std::size_t kMaxWords = 8;
  std::vector<std::string> words;
  std::string word;
  for (const char c : text) {
    if (!separates_words(static_cast<unsigned char>(c)))
      word += c;
    else if (!word.empty())
      words.push_back(std::exchange(word, {}));
  }
  if (!word.empty()) words.push_back(word);
  words.resize(std::min(words.size(), kMaxWords));
  return words;
}

// The SQL condition on rows of `model_index` for a query, without the condition for its cursor.
class Filter {
 public:
  Filter(const DatabaseConnection& connection, const ModelQuery& query)
      : query_(&query), words_(words_of(query.text)) {
    if (!words_.empty()) {
      sql_ += fmt::format(" AND {}", connection.text_condition());
      text_ = connection.text_query(words_);
    }
    for (std::size_t i = 0; i < query.facets.size(); ++i)
      sql_ +=
          " AND facets LIKE "
          "(SELECT '% ' || id || ' %' FROM facet_value WHERE name = ? AND value = ?)";
  }

  const std::string& sql() const { return sql_; }

  void bind(Statement& rows) const {
    rows.bind(std::int64_t{query_->includes_drafts ? 0 : 1});
    if (!words_.empty()) rows.bind(text_);
    for (const auto& [name, value] : query_->facets)
      rows.bind(name).bind(value);
  }

 private:
  const ModelQuery* query_;
  std::vector<std::string> words_;
  std::string text_, sql_ = "state >= ?";
};

struct OrderClauses {
  std::string after;         // condition that a row of `model_index` comes after the cursor
  std::string index, model;  // the order of rows of `model_index` and of `model`
};

OrderClauses clauses_of(ModelOrdering ordering, const DatabaseConnection& connection) {
  if (ordering == ModelOrdering::kNewest) return {"model < ?", "model DESC", "id DESC"};
  if (ordering == ModelOrdering::kOldest) return {"model > ?", "model", "id"};
  const char* column = ordering == ModelOrdering::kTitle ? "title" : "creator";
  return {
      fmt::format("({0}, model) > (SELECT {0}, model FROM model_index WHERE model = ?)", column),
      fmt::format("{}, model", column),
      fmt::format("lower({}){}, id", column, connection.by_bytes())};
}

// Counts, for each facet value, the models that have it. Values are identified by their ids.
class Tally {
 public:
  // Counts the values of a model. `ids` contains the ids of the values, with a space before and
  // after each. An id that occurs twice counts once.
  void add(const std::string& ids) {
    ++models_;
    const char* const end = ids.data() + ids.size();
    for (const char* at = ids.data(); at < end; ++at) {
      std::size_t id = 0;
      const auto read = std::from_chars(at, end, id);
      if (read.ec == std::errc()) count(id);
      if (read.ptr > at) at = read.ptr;
    }
  }

  std::uint64_t of(std::uint64_t id) const {
    const auto found = counts_.find(id);
    return found == counts_.end() ? 0 : found->second.models;
  }
  std::uint64_t models() const { return models_; }

 private:
  struct Count {
    std::uint64_t models = 0, last = 0;  // `last`: number of the last counted model
  };

  void count(std::uint64_t id) {
    Count& value = counts_[id];
    if (value.last != models_) ++value.models;
    value.last = models_;
  }

  std::unordered_map<std::uint64_t, Count> counts_;
  std::uint64_t models_ = 0;
};

// Counts the values of all models that the query finds.
Tally tally_of(DatabaseConnection& connection, const ModelQuery& query) {
  const Filter filter(connection, query);
  Tally tally;
  const ScopedStatement found(
      connection.prepare("SELECT facets FROM model_index WHERE " + filter.sql()));
  for (filter.bind(*found); found->step();)
    tally.add(found->text(0));
  return tally;
}

// Keeps the most frequent values of each facet. `counts` must be ordered by name and value.
std::vector<FacetCount> most_frequent(std::vector<FacetCount> counts) {
  std::vector<FacetCount> kept;
  for (auto first = counts.begin(); first != counts.end();) {
    const auto last = std::find_if(first, counts.end(),
                                   [&](const FacetCount& c) { return c.name != first->name; });
    std::stable_sort(first, last,
                     [](const FacetCount& a, const FacetCount& b) { return a.models > b.models; });
    const auto most = std::min<std::ptrdiff_t>(last - first, kMostFacetValues);
    kept.insert(kept.end(), std::make_move_iterator(first), std::make_move_iterator(first + most));
    first = last;
  }
  return kept;
}

}  // namespace

ModelPage search_models(DatabaseConnection& connection, const ModelQuery& query) {
  const Filter filter(connection, query);
  const OrderClauses clauses = clauses_of(query.ordering, connection);
  std::string which = filter.sql();
  if (query.after) which += " AND " + clauses.after;
  const std::string found = fmt::format(
      "SELECT model FROM model_index WHERE {} ORDER BY {} LIMIT ?", which, clauses.index);
  const ScopedStatement rows(connection.prepare(
      select_models(fmt::format("id IN ({}) ORDER BY {}", found, clauses.model))));
  filter.bind(*rows);
  if (query.after) rows->bind(query.after->bytes());
  const std::uint32_t limit = std::clamp(query.limit, 1u, kMaxPage);
  rows->bind(std::int64_t{limit} + 1);  // a row beyond the limit means that there is a next page

  ModelPage page;
  while (rows->step())
    page.models.push_back(read_model(*rows));
  if (page.models.size() > limit) {
    page.models.pop_back();
    page.next = page.models.back().id;
  }
  return page;
}

Facets count_facets(DatabaseConnection& connection, const ModelQuery& query) {
  const Tally tally = tally_of(connection, query);
  Facets facets{.models = tally.models()};

  const ScopedStatement values(
      connection.prepare("SELECT id, name, value FROM facet_value ORDER BY name, value"));
  while (values->step()) {
    if (const auto models = tally.of(sql::count(*values, 0)); models > 0)
      facets.counts.push_back(
          {.name = values->text(1), .value = values->text(2), .models = models});
  }
  facets.counts = most_frequent(std::move(facets.counts));
  return facets;
}

std::vector<std::string> list_collections(DatabaseConnection& connection) {
  const Tally tally = tally_of(connection, {});
  const ScopedStatement values(connection.prepare(
      "SELECT id, value FROM facet_value WHERE name = 'collection' ORDER BY value"));
  std::vector<std::string> names;
  while (values->step())
    if (tally.of(sql::count(*values, 0)) > 0) names.push_back(values->text(1));
  return names;
}

}  // namespace vitrine::server
