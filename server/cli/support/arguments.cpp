// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "server/config/help_text.h"

namespace vitrine::server::cli {
namespace {

const Flag* find(std::span<const Flag> flags, std::string_view name) {
  const auto it =
      std::find_if(flags.begin(), flags.end(), [&](const Flag& f) { return f.name == name; });
  return it == flags.end() ? nullptr : &*it;
}

tl::unexpected<Fault> unknown_flag(std::string_view name, std::span<const Flag> flags) {
  std::vector<std::string_view> names;
  for (const Flag& flag : flags)
    names.push_back(flag.name);
  const std::string_view near = suggest(name, names);
  return misused(fmt::format("unknown flag {}{}", name,
                             near.empty() ? "" : fmt::format(" (did you mean {}?)", near)));
}

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

tl::expected<Arguments, Fault> Arguments::parse(std::span<const std::string_view> words,
                                                std::span<const Flag> flags,
                                                std::span<const std::string_view> operands) {
  Arguments result;
  bool flags_ended = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (flags_ended || word.size() < 2 || word[0] != '-') {
      result.operands_.emplace_back(word);
      continue;
    }
    if (word == "--") {
      flags_ended = true;
      continue;
    }
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    const Flag* flag = find(flags, name);
    if (flag == nullptr) return unknown_flag(name, flags);
    if (result.has(name)) return misused(fmt::format("{} is given twice", name));
    std::string_view value;
    if (flag->value.empty()) {
      if (equals != word.npos) return misused(fmt::format("{} takes no value", name));
    } else if (equals != word.npos) {
      value = word.substr(equals + 1);
    } else if (++i < words.size()) {
      value = words[i];
    } else {
      return misused(fmt::format("{} needs a value: {}", name, flag->value));
    }
    result.values_.emplace(name, value);
  }
  if (result.operands_.size() < operands.size()) {
    return misused(fmt::format("{} is missing", operands[result.operands_.size()]));
  }
  const bool takes_more = !operands.empty() && operands.back().ends_with("...");
  if (result.operands_.size() > operands.size() && !takes_more) {
    return misused(fmt::format("unexpected word \"{}\"", result.operands_[operands.size()]));
  }
  return result;
}

std::string Arguments::text(std::string_view flag, std::string_view otherwise) const {
  const auto it = values_.find(flag);
  return it == values_.end() ? std::string(otherwise) : it->second;
}

tl::unexpected<Fault> Arguments::wrong_value(std::string_view flag, std::string_view wanted) const {
  return misused(fmt::format("{} cannot be \"{}\"; give {}", flag, text(flag), wanted));
}

tl::expected<std::optional<std::uint64_t>, Fault> Arguments::number(std::string_view flag,
                                                                    std::uint64_t low,
                                                                    std::uint64_t high) const {
  if (!has(flag)) return std::nullopt;
  const auto value = parse_number<std::uint64_t>(text(flag));
  if (value && *value >= low && *value <= high) return value;
  return wrong_value(flag, high == UINT64_MAX
                               ? fmt::format("a whole number of at least {}", low)
                               : fmt::format("a whole number from {} to {}", low, high));
}

tl::expected<std::optional<double>, Fault> Arguments::distance(std::string_view flag) const {
  if (!has(flag)) return std::nullopt;
  const auto value = parse_number<double>(text(flag));
  if (value && std::isfinite(*value) && *value >= 0) return value;
  return wrong_value(flag, "a number of at least 0, in the model's unit");
}

tl::expected<std::optional<double>, Fault> Arguments::number_between(std::string_view flag,
                                                                     double low,
                                                                     double high) const {
  if (!has(flag)) return std::nullopt;
  const auto value = parse_number<double>(text(flag));
  if (value && *value >= low && *value <= high) return value;
  return wrong_value(flag, fmt::format("a number from {} to {}", low, high));
}

tl::expected<std::size_t, Fault> Arguments::choice(
    std::string_view flag, std::span<const std::string_view> choices) const {
  if (!has(flag)) return 0;
  const auto it = std::find(choices.begin(), choices.end(), text(flag));
  if (it != choices.end()) return static_cast<std::size_t>(it - choices.begin());
  return wrong_value(flag, fmt::format("one of {}", fmt::join(choices, ", ")));
}

}  // namespace vitrine::server::cli
