// SPDX-License-Identifier: Apache-2.0
#include "server/cli/support/access_token.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace vitrine::server::cli {
namespace {

bool is_one_word(std::string_view text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7F; });
}

// Returns the first line of a file that may be a pipe. Reads at most kLongest bytes.
tl::expected<std::string, Fault> read_first_line(const std::string& path) {
  constexpr std::streamsize kLongest = 4096;
  std::ifstream in(path, std::ios::binary);
  std::string text(kLongest, '\0');
  in.read(text.data(), kLongest);
  if (in.gcount() == 0) {
    return failed(fmt::format("cannot read a token from {}; check its name and permissions", path));
  }
  text.resize(static_cast<std::size_t>(in.gcount()));
  return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace

bool names_token(const Arguments& arguments) {
  return arguments.has("--token") || arguments.has(kTokenFileFlag.name);
}

tl::expected<std::string, Fault> access_token(const Arguments& arguments) {
  if (arguments.has("--token") && arguments.has(kTokenFileFlag.name))
    return misused("--token and --token-file exclude each other; give one");
  if (arguments.has("--token")) {
    std::string token = arguments.text("--token");
    if (!is_one_word(token)) return arguments.wrong_value("--token", "a token's text");
    return token;
  }
  if (arguments.has(kTokenFileFlag.name)) {
    auto token = read_first_line(arguments.text(kTokenFileFlag.name));
    if (token && !is_one_word(*token))
      return arguments.wrong_value(kTokenFileFlag.name, "a file whose first line is a token");
    return token;
  }
  const char* token = std::getenv("VITRINE_TOKEN");
  if (token == nullptr || *token == '\0') return std::string();
  if (!is_one_word(token)) return misused("VITRINE_TOKEN is not a token; set it to a token's text");
  return std::string(token);
}

}  // namespace vitrine::server::cli
