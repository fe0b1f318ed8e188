// SPDX-License-Identifier: Apache-2.0
// bench-search: fills a catalogue with 10,000 models, in SQLite and in PostgreSQL, and measures
// searches and counts of facets. Prints the median and the 95th percentile of each. The exit code
// is 0 only if each 95th percentile is at most 50 ms.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/catalogue/postgres_catalogue.h"
#include "server/catalogue/sql_catalogue.h"
#include "server/catalogue/sqlite_catalogue.h"
#include "support/process/postgres_server.h"
#include "support/temporary_folder.h"

namespace vitrine::bench {
namespace {

using server::Catalogue;
using server::ModelQuery;
using server::ModelRecord;

constexpr int kModels = 10'000, kRuns = 200;
constexpr double kMostMilliseconds = 50;

// Makes texts of invented words. Some words are frequent, most are rare.
class Texts {
 public:
  Texts() {
    for (int i = 0; i < 5'000; ++i) {
      std::string word;
      for (auto letters = 4 + random_() % 6; letters > 0; --letters)
        word += static_cast<char>('a' + random_() % 20);
      words_.push_back(word);
    }
  }

  std::string words(int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += words_[random_() % (1 + random_() % words_.size())] + ' ';
    return text;
  }
  std::string one_of(const char* kind, unsigned count) {
    return fmt::format("{} {}", kind, random_() % count);
  }
  std::string beginning(std::size_t letters) {
    return words_[random_() % words_.size()].substr(0, letters);
  }

 private:
  std::mt19937 random_{1};  // the same texts in each run
  std::vector<std::string> words_;
};

void fill(Catalogue& catalogue, Texts& texts) {
  for (int i = 0; i < kModels; ++i) {
    ModelRecord model{.id = server::ModelId::generate(), .state = server::ModelState::kPublished};
    model.title = texts.words(3);
    model.creator = texts.one_of("creator", 1'000);
    model.licence = i % 3 == 0 ? "CC0-1.0" : "CC-BY-4.0";
    model.more = {{"subject", texts.one_of("subject", 300) + "; " + texts.one_of("subject", 300)},
                  {"material", texts.one_of("material", 20)},
                  {"period", texts.one_of("period", 40)},
                  {"collection", texts.one_of("collection", 15)},
                  {"description", texts.words(80)}};
    if (const auto added = catalogue.add(model, {}); !added)
      throw std::runtime_error(added.error().message);
  }
}

// Measures `action`, prints its times and returns whether they are short enough.
template <class Action>
bool measure(const char* where, const char* what, Action&& action) {
  std::vector<double> times;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    action();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count());
  }
  std::ranges::sort(times);
  const double p95 = times[times.size() * 95 / 100];
  fmt::print("{:<11} {:<42} median {:6.1f} ms, p95 {:6.1f} ms\n", where, what,
             times[times.size() / 2], p95);
  return p95 <= kMostMilliseconds;
}

bool measure_all(const char* where, Catalogue& catalogue) {
  Texts texts;
  fill(catalogue, texts);
  const auto search = [&](ModelQuery query) { static_cast<void>(catalogue.search(query).value()); };
  const auto facets = [&](ModelQuery query) { static_cast<void>(catalogue.facets(query).value()); };
  using enum server::ModelOrdering;
  bool fits = measure(where, "all, newest first", [&] { search({}); });
  fits &= measure(where, "all, by title", [&] { search({.ordering = kTitle}); });
  fits &= measure(where, "a word", [&] { search({.text = texts.beginning(9)}); });
  fits &= measure(where, "a letter, by title",
                  [&] { search({.text = texts.beginning(1), .ordering = kTitle}); });
  fits &= measure(where, "two beginnings and a material", [&] {
    search({.text = texts.beginning(2) + ' ' + texts.beginning(1),
            .facets = {{"material", texts.one_of("material", 20)}}});
  });
  fits &= measure(where, "facets of all", [&] { facets({}); });
  fits &= measure(where, "facets of a letter", [&] { facets({.text = texts.beginning(1)}); });
  fits &= measure(where, "facets of a collection", [&] {
    facets({.facets = {{"collection", texts.one_of("collection", 15)}}});
  });
  return fits;
}

bool run() {
  const test::TemporaryFolder folder;
  const auto sqlite = server::open_sqlite_catalogue(folder.path() / "catalogue.sqlite").value();
  const bool fits = measure_all("SQLite", *sqlite);
  const auto postgres = server::make_catalogue(
      server::postgres::open_database(test::new_database()).value().database);
  return measure_all("PostgreSQL", *postgres) && fits;
}

}  // namespace
}  // namespace vitrine::bench

int main(int argc, char** argv) {
  const bool help = argc == 2 && std::string_view(argv[1]) == "--help";
  if (argc > 1) {
    fmt::print(help ? stdout : stderr, "Usage: bench-search\n");
    return help ? 0 : 2;
  }
  try {
    return vitrine::bench::run() ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench-search: {}\n", error.what());
    return 1;
  }
}
