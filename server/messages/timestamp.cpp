// SPDX-License-Identifier: Apache-2.0
#include "server/messages/timestamp.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

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

}  // namespace vitrine::server
