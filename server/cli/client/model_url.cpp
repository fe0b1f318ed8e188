// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/model_url.h"

#include <fmt/core.h>

#include <regex>

namespace vitrine::server {

std::string ModelUrl::authority() const {
  const bool v6 = host.find(':') != std::string::npos;
  return fmt::format("{}{}{}:{}", v6 ? "[" : "", host, v6 ? "]" : "", port);
}

std::string ModelUrl::resource() const {
  return target.substr(0, target.size() - std::string_view("/stream").size());
}

Expected<ModelUrl> parse_model_url(std::string_view url) {
  // Longest accepted text. std::regex is recursive, so a longer text could overflow the stack.
  constexpr std::size_t kLongest = 2048;
  static const std::regex kModel(
      R"((https?)://(?:\[([0-9a-fA-F:.]+)\]|([^/:@?#\s]+))(?::([0-9]{1,5}))?((?:/[^?#\s]*)?)/models/([0-9a-z]+)/?(?:[?#]\S*)?)");
  std::match_results<std::string_view::const_iterator> parts;
  if (url.size() > kLongest || !std::regex_match(url.begin(), url.end(), parts, kModel)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not the URL of a model; give, for example, "
                            "http://host:8080/models/ID",
                            url.substr(0, 200)));
  }
  const bool is_encrypted = parts.str(1) == "https";
  std::string base = parts.str(5);
  if (base.ends_with("/api/v1")) base.resize(base.size() - std::string_view("/api/v1").size());
  return ModelUrl{.host = parts[2].matched ? parts.str(2) : parts.str(3),
                  .port = parts[4].matched ? parts.str(4)
                          : is_encrypted   ? "443"
                                           : "80",
                  .target = fmt::format("{}/api/v1/models/{}/stream", base, parts.str(6)),
                  .is_encrypted = is_encrypted};
}

}  // namespace vitrine::server
