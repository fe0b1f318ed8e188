// SPDX-License-Identifier: Apache-2.0
// Secrets finds content that a response must not contain. AccessMatrix is a table of the statuses
// of all responses.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace vitrine::test {

// Content that a visitor must not get. Stores a hash of every substring that is kWindow bytes long.
class Secrets {
 public:
  void hide(std::string_view content) {
    each_window(content, [&](std::size_t window) { windows_.insert(window); });
  }
  void reveal(std::string_view content) {
    each_window(content, [&](std::size_t window) { windows_.erase(window); });
  }
  bool are_in(std::string_view text) const {
    bool found = false;
    each_window(text, [&](std::size_t window) { found |= windows_.contains(window); });
    return found;
  }

 private:
  static constexpr std::size_t kWindow = 16;

  template <class Use>
  static void each_window(std::string_view text, const Use& use) {
    for (std::size_t i = 0; i + kWindow <= text.size(); ++i)
      use(std::hash<std::string_view>{}(text.substr(i, kWindow)));
  }

  std::unordered_set<std::size_t> windows_;
};

// The access matrix. For each route and column, it holds the lowest HTTP status of all responses.
class AccessMatrix {
 public:
  void record(const std::string& route, const std::string& column, int status) {
    if (std::ranges::find(columns_, column) == columns_.end()) columns_.push_back(column);
    int& best = rows_[route][column];
    if (best == 0 || status < best) best = status;
  }
  void print() const {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      fmt::print("[{}] {}\n", i + 1, columns_[i]);
    fmt::print("{:66}", "");
    for (std::size_t i = 0; i < columns_.size(); ++i)
      fmt::print("{:>5}", fmt::format("[{}]", i + 1));
    for (const auto& [route, cells] : rows_) {
      fmt::print("\n{:66}", route);
      for (const std::string& column : columns_)
        fmt::print("{:>5}", cells.contains(column) ? fmt::format("{}", cells.at(column)) : "");
    }
    fmt::print("\n");
  }

 private:
  std::vector<std::string> columns_;
  std::map<std::string, std::map<std::string, int>> rows_;
};

}  // namespace vitrine::test
