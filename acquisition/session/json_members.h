// SPDX-License-Identifier: Apache-2.0
// Reads small JSON files, which people may have written by hand. Each error names the file, the key
// and the expected value.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"

namespace vitrine::acquisition {

inline constexpr std::size_t kMaxJsonBytes = 1 << 20;

// Parses `text` as a JSON object. Errors call the file `place`.
Expected<nlohmann::json> parse_json_object(std::string_view text, const std::string& place);

// Reads the members of one object. A read that fails returns `otherwise`. The first error is kept,
// so one check() after a sequence of reads is enough.
class JsonMembers {
 public:
  // Reports an error for each key that is not in `known`. `object` must outlive this reader.
  JsonMembers(const nlohmann::json& object, std::string place,
              std::initializer_list<std::string_view> known);

  bool has(std::string_view key) const { return object_.contains(key); }
  std::string text(std::string_view key, std::string_view otherwise = "");
  double number(std::string_view key, double low, double high, double otherwise);
  int whole(std::string_view key, int low, int high, int otherwise);
  bool flag(std::string_view key, bool otherwise);
  // Reads one of `choices` and returns its index.
  std::size_t choice(std::string_view key, std::span<const std::string_view> choices,
                     std::size_t otherwise);
  // object() returns a reader of a nested object, which is empty if the key is absent. adopt()
  // takes over the first error of that reader.
  JsonMembers object(std::string_view key, std::initializer_list<std::string_view> known);
  void adopt(const JsonMembers& inner);

  // Reports an error. `what` has the form "must be …".
  void fault(std::string_view key, std::string_view what);
  Expected<void> check() const;

 private:
  const nlohmann::json* find(std::string_view key) const;

  const nlohmann::json& object_;
  std::string place_;  // place in the file, such as "rig.json" or "rig.json: camera"
  std::optional<Error> fault_;
};

}  // namespace vitrine::acquisition
