// SPDX-License-Identifier: Apache-2.0
// Parses the words of a command line and checks them against the command's declaration.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "server/cli/support/outcome.h"

namespace vitrine::server::cli {

struct Flag {
  std::string_view name;   // such as "--level"; the only short flag is "-o"
  std::string_view value;  // name of the value in --help; empty for a switch
  std::string_view help;
};

class Arguments {
 public:
  // Parses the words after the command's name. Accepts `--flag value` and `--flag=value`. All other
  // words are operands, which may be at any position. "--" ends the flags. The last operand may be
  // repeated if its name ends in "...", as in "SCAN...". A usage error names the wrong word, and a
  // similar flag if there is one.
  static tl::expected<Arguments, Fault> parse(std::span<const std::string_view> words,
                                              std::span<const Flag> flags,
                                              std::span<const std::string_view> operands);

  const std::vector<std::string>& operands() const { return operands_; }
  std::string operand(std::size_t index) const { return operands_[index]; }
  bool has(std::string_view flag) const { return values_.contains(flag); }
  std::string text(std::string_view flag, std::string_view otherwise = "") const;
  // Returns a usage error: the value of `flag` is not of the kind that `wanted` describes.
  tl::unexpected<Fault> wrong_value(std::string_view flag, std::string_view wanted) const;

  // Returns the value as a whole number in [low, high]; nullopt if the flag is absent.
  tl::expected<std::optional<std::uint64_t>, Fault> number(std::string_view flag, std::uint64_t low,
                                                           std::uint64_t high) const;
  // Returns the value as a finite number of at least 0; nullopt if the flag is absent.
  tl::expected<std::optional<double>, Fault> distance(std::string_view flag) const;
  // Returns the value as a number in [low, high]; nullopt if the flag is absent.
  tl::expected<std::optional<double>, Fault> number_between(std::string_view flag, double low,
                                                            double high) const;
  // Returns the index of the value in `choices`; 0 if the flag is absent.
  tl::expected<std::size_t, Fault> choice(std::string_view flag,
                                          std::span<const std::string_view> choices) const;

 private:
  std::vector<std::string> operands_;
  std::map<std::string, std::string, std::less<>> values_;
};

}  // namespace vitrine::server::cli
