// SPDX-License-Identifier: Apache-2.0
// The words of one command line, checked against what the command declares.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/cli/outcome.h"

namespace vitrine::cli {

struct Flag {
  std::string_view name;   // "--level"; "-o" is the one short flag
  std::string_view value;  // what --help calls its value; empty: a switch
  std::string_view help;
};

class Arguments {
 public:
  // Takes `--flag value`, `--flag=value` and, in any place, `operands` other words; "--" ends the
  // flags. Of a last operand that is named "...", as in "SCAN...", there may be more. A fault of
  // usage names the word, and a near flag where there is one.
  static tl::expected<Arguments, Fault> parse(std::span<const std::string_view> words,
                                              std::span<const Flag> flags,
                                              std::span<const std::string_view> operands);

  const std::vector<std::string>& operands() const { return operands_; }
  std::string operand(std::size_t index) const { return operands_[index]; }
  bool has(std::string_view flag) const { return values_.contains(flag); }
  std::string text(std::string_view flag, std::string_view otherwise = "") const;
  // The fault of a value that is not `wanted`.
  tl::unexpected<Fault> wrong_value(std::string_view flag, std::string_view wanted) const;

  // The value as a whole number in [low, high], or nothing where the flag is absent.
  tl::expected<std::optional<std::uint64_t>, Fault> number(std::string_view flag, std::uint64_t low,
                                                           std::uint64_t high) const;
  // The value as a finite number of at least 0.
  tl::expected<std::optional<double>, Fault> distance(std::string_view flag) const;
  // The value as a number in [low, high].
  tl::expected<std::optional<double>, Fault> number_between(std::string_view flag, double low,
                                                            double high) const;
  // The value's place among `choices`; 0 where the flag is absent.
  tl::expected<std::size_t, Fault> choice(std::string_view flag,
                                          std::span<const std::string_view> choices) const;

 private:
  std::vector<std::string> operands_;
  std::map<std::string, std::string, std::less<>> values_;
};

}  // namespace vitrine::cli
