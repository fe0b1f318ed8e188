// SPDX-License-Identifier: Apache-2.0
#include "server/messages/timestamp.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "codec/core/parse_number.h"

namespace vitrine::server {

std::string timestamp(std::int64_t milliseconds) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z",
                     fmt::gmtime(static_cast<std::time_t>(milliseconds / 1000)),
                     milliseconds % 1000);
}

std::string http_date(std::int64_t seconds) {
  return fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT",
                     fmt::gmtime(static_cast<std::time_t>(seconds)));
}

std::string utc_time(std::int64_t seconds) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

std::optional<std::chrono::sys_days> parse_date(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return std::nullopt;
  const auto year = parse_number<std::uint16_t>(text.substr(0, 4));
  const auto month = parse_number<std::uint8_t>(text.substr(5, 2));
  const auto day = parse_number<std::uint8_t>(text.substr(8, 2));
  if (!year || *year == 0 || !month || !day) return std::nullopt;
  const auto date = std::chrono::year(*year) / int{*month} / int{*day};
  return date.ok() ? std::optional(std::chrono::sys_days(date)) : std::nullopt;
}

std::optional<std::int64_t> parse_utc_time(std::string_view text) {
  if (text.size() != 20 || text[10] != 'T' || text[13] != ':' || text[16] != ':' || text[19] != 'Z')
    return std::nullopt;
  const auto date = parse_date(text.substr(0, 10));
  const auto hours = parse_number<std::uint8_t>(text.substr(11, 2));
  const auto minutes = parse_number<std::uint8_t>(text.substr(14, 2));
  const auto seconds = parse_number<std::uint8_t>(text.substr(17, 2));
  if (!date || !hours || *hours > 23 || !minutes || *minutes > 59 || !seconds || *seconds > 59)
    return std::nullopt;
  return std::chrono::seconds(date->time_since_epoch()).count() + *hours * 3600 + *minutes * 60 +
         *seconds;
}

}  // namespace vitrine::server
