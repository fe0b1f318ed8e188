// SPDX-License-Identifier: Apache-2.0
// Reads the fields of a JSON request and collects all faults, each with the name of its field.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "server/store/publish.h"

namespace vitrine::server {

struct FieldFault {
  // name of the field, such as "metadata.title", and a description of the expected value
  std::string field, detail;
};
using FieldFaults = std::vector<FieldFault>;

inline constexpr std::string_view kPlacementNames[] = {"midpoint", "pyramid"};

// Reads the members of a JSON object into variables. If a member is absent or invalid, the variable
// stays unchanged. An invalid member is added to the faults.
class Fields {
 public:
  Fields(const nlohmann::json& object, std::string prefix, FieldFaults& faults)
      : object_(object), prefix_(std::move(prefix)), faults_(faults) {}

  void only(std::span<const std::string_view> known);  // reports each member not in `known`
  void text(const char* name, std::string& value);     // null makes the text empty [RFC7396]
  // Reads a text that may have several paragraphs. Removes carriage returns.
  void paragraphs(const char* name, std::string& value);
  // Reads an array of lines. Joins them by line feeds to a text of several paragraphs.
  void lines(const char* name, std::string& value);
  void whole(const char* name, int low, int high, int& value);
  void flag(const char* name, bool& value);

  // Reads a number from `low` to `high`. `value` is a double or a std::optional<double>.
  void real(const char* name, double low, double high, auto& value) {
    const auto found = object_.find(name);
    if (found == object_.end() || found->is_null()) return;
    if (!found->is_number() || !(*found >= low && *found <= high)) {
      return fault(name, fmt::format("a number from {} to {}", low, high));
    }
    value = found->template get<double>();
  }

  template <class Enum>
  void choice(const char* name, std::span<const std::string_view> names, Enum& value) {
    const auto found = object_.find(name);
    if (found == object_.end()) return;
    const auto* given = found->get_ptr<const std::string*>();
    const auto at = given == nullptr ? names.end() : std::ranges::find(names, *given);
    if (at == names.end()) return fault(name, fmt::format("one of {}", fmt::join(names, ", ")));
    value = static_cast<Enum>(at - names.begin());
  }

  void fault(const std::string& name, std::string expected) {
    faults_.push_back({prefix_ + name, std::move(expected)});
  }

 private:
  const nlohmann::json& object_;
  const std::string prefix_;
  FieldFaults& faults_;
};

template <class Order>
tl::expected<Order, FieldFaults> order_or_faults(Order order, FieldFaults faults) {
  if (!faults.empty()) return tl::unexpected(std::move(faults));
  return order;
}

// These functions read fields that several requests have in common: "bits" and "metadata". If
// "bits" is 0 or "auto", the number of bits is chosen for the mesh.
void read_bits(Fields& fields, const nlohmann::json& body, int& bits);
void read_metadata(Fields& fields, const nlohmann::json& body, ModelMetadata& metadata,
                   FieldFaults& faults);

// Returns the names of the metadata texts: title, creator, rights, licence and the elements of
// Dublin Core.
std::vector<std::string_view> metadata_names();
void read_texts(Fields& fields, ModelMetadata& metadata);
nlohmann::json to_json(const ModelMetadata& metadata);

}  // namespace vitrine::server
