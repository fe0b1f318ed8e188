// SPDX-License-Identifier: Apache-2.0
// Reading of small JSON files that people may have written: each fault names file, key and what is
// expected there.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine {

inline constexpr std::size_t kMaxJsonBytes = 1 << 20;

// The object that `text` holds; `place` is the file's name.
Expected<nlohmann::json> parse_json_object(std::string_view text, const std::string& place);

// The members of one object. A read that fails gives `otherwise`, and the first fault is kept, so
// that a sequence of reads is checked once.
class JsonMembers {
 public:
  // A key that is not in `known` is a fault. `object` outlives this.
  JsonMembers(const nlohmann::json& object, std::string place,
              std::initializer_list<std::string_view> known);

  bool has(std::string_view key) const { return object_.contains(key); }
  std::string text(std::string_view key, std::string_view otherwise = "");
  double number(std::string_view key, double low, double high, double otherwise);
  int whole(std::string_view key, int low, int high, int otherwise);
  bool flag(std::string_view key, bool otherwise);
  // The value's place among `choices`.
  std::size_t choice(std::string_view key, std::span<const std::string_view> choices,
                     std::size_t otherwise);
  // An object, empty where the key is absent. Its faults are to be collected by adopt().
  JsonMembers object(std::string_view key, std::initializer_list<std::string_view> known);
  void adopt(const JsonMembers& inner);

  // `what`: "must be …".
  void fault(std::string_view key, std::string_view what);
  Expected<void> check() const;

 private:
  const nlohmann::json* find(std::string_view key) const;

  const nlohmann::json& object_;
  std::string place_;  // "rig.json" or "rig.json: camera"
  std::optional<Error> fault_;
};

}  // namespace vitrine
