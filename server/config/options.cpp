// SPDX-License-Identifier: Apache-2.0
#include "server/config/options.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <limits>

namespace vitrine {
namespace {

Expected<std::uint64_t> parse_number(std::string_view text, std::uint64_t min, std::uint64_t max) {
  std::uint64_t value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault != std::errc{} || end != text.data() + text.size() || value < min || value > max) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a whole number from {} to {}; give one", text, min, max));
  }
  return value;
}

bool is_numeric_address(std::string_view host) {
  const std::string address(host.substr(0, host.find('%')));  // without the zone of fe80::1%eth0
  in6_addr parsed;
  return ::inet_pton(AF_INET, address.c_str(), &parsed) == 1 ||
         ::inet_pton(AF_INET6, address.c_str(), &parsed) == 1;
}

Expected<Endpoint> parse_endpoint(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not HOST:PORT; give, for example, 127.0.0.1:8080", text));
  }
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (host == "localhost") host = "127.0.0.1";
  if (!is_numeric_address(host)) {
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is not a numeric address; give, for example, 127.0.0.1 or [::1]", host));
  }
  const auto port = parse_number(text.substr(colon + 1), 0, 65535);
  if (!port) return Unexpected(port.error());
  return Endpoint{std::string(host), static_cast<std::uint16_t>(*port)};
}

template <auto Member>
Expected<void> endpoint(Settings& settings, std::string_view text) {
  auto value = parse_endpoint(text);
  if (!value) return Unexpected(value.error());
  settings.*Member = std::move(*value);
  return {};
}

template <auto Member>
Expected<void> path(Settings& settings, std::string_view text) {
  settings.*Member = std::filesystem::path(text);
  return {};
}

// Replaces `list` by the parts of "A,B,…". `missing`: what to say of an empty one.
template <class List>
Expected<void> parse_list(List& list, std::string_view text, const char* missing) {
  list.clear();
  while (!text.empty()) {
    const std::string_view one = text.substr(0, text.find(','));
    if (one.empty()) return fail(ErrorCode::kBadInput, missing);
    list.emplace_back(one);
    text.remove_prefix(std::min(text.size(), one.size() + 1));
  }
  return {};
}

Expected<void> scanners(Settings& settings, std::string_view text) {
  return parse_list(settings.scanners, text, "a path in it is empty; name the rig.json");
}

Expected<void> webhook_hosts(Settings& settings, std::string_view text) {
  return parse_list(settings.webhook_hosts, text, "a host in it is empty; name the server");
}

Expected<void> data_folder(Settings& settings, std::string_view text) {
  if (text.empty()) return fail(ErrorCode::kBadInput, "it is empty; name the data folder");
  return path<&Settings::data>(settings, text);
}

template <auto Member, std::uint64_t Min, std::uint64_t Max>
Expected<void> number(Settings& settings, std::string_view text) {
  const auto value = parse_number(text, Min, Max);
  if (!value) return Unexpected(value.error());
  using Target = std::remove_reference_t<decltype(settings.*Member)>;
  settings.*Member = static_cast<Target>(*value);
  return {};
}

using S = Settings;
using enum OptionType;

constexpr std::array kOptions{
    Option{"listen", kEndpoint, "127.0.0.1:8080",
           "Where visitors connect. Port 0 takes any free port.", false, endpoint<&S::listen>},
    Option{"data", kPath, "./data", "The folder of this installation: objects and catalogue.",
           false, data_folder},
    Option{"port-file", kPath, "", "A file to write the port of 'listen' to once it is bound.",
           false, path<&S::port_file>},
    Option{"admin-listen", kEndpoint, "127.0.0.1:0",
           "Where /livez, /readyz and /metrics are. Keep it off public networks.", false,
           endpoint<&S::admin_listen>},
    Option{"admin-port-file", kPath, "",
           "A file to write the port of 'admin-listen' to once it is bound.", false,
           path<&S::admin_port_file>},
    Option{"access-log", kPath, "-", "One line per request. '-' is standard error; empty is none.",
           false, path<&S::access_log>},
    Option{"threads", kCount, "0", "Threads that serve connections. 0 is one per core.", false,
           number<&S::threads, 0, 1024>},
    Option{"max-connections", kCount, "10000", "Connections beyond this number are closed at once.",
           false, number<&S::max_connections, 1, 1'000'000>},
    Option{"idle-timeout", kSeconds, "30",
           "How long a connection may take for a request's header, or to accept more bytes.", false,
           number<&S::idle_timeout, 1, 3600>},
    Option{"stop-timeout", kSeconds, "20",
           "After SIGTERM, how long transfers may take to finish before they are cut.", false,
           number<&S::stop_timeout, 0, 3600>},
    Option{"export-cache", kBytes, "268435456", "Memory for exported files that are kept ready.",
           false, number<&S::export_cache_bytes, 0, std::numeric_limits<std::uint64_t>::max()>},
    Option{"max-upload", kBytes, "8589934592", "Bytes that an uploaded file may have.", false,
           number<&S::max_upload_bytes, 0, std::numeric_limits<std::int64_t>::max()>},
    Option{"max-uploads", kCount, "16", "Uploads that one token may have open at a time.", false,
           number<&S::max_uploads, 1, 100'000>},
    Option{"upload-lifetime", kSeconds, "86400",
           "How long an upload is kept after its last piece, unless a job uses it.", false,
           number<&S::upload_lifetime, 1, 31'536'000>},
    Option{"collect-after", kSeconds, "3600",
           "How long a stored file is kept that no model names any more.", false,
           number<&S::collect_after, 0, 31'536'000>},
    Option{"quota", kBytes, "0", "Bytes that models and uploads together may take. 0: no limit.",
           false, number<&S::quota_bytes, 0, std::numeric_limits<std::int64_t>::max()>},
    Option{
        "webhook-hosts", kNames, "",
        "The servers that may be told of the ends of jobs: HOST or HOST:PORT, separated by commas.",
        false, webhook_hosts},
    Option{"scanners", kPaths, "",
           "The rig.json files of the scanners that this daemon drives, separated by commas.",
           false, scanners},
};

}  // namespace

std::span<const Option> options() {
  return kOptions;
}

const Option* find_option(std::string_view key) {
  const auto found = std::ranges::find(kOptions, key, &Option::key);
  return found == kOptions.end() ? nullptr : &*found;
}

std::string environment_name(const Option& option) {
  std::string name = "VITRINE_";
  for (const char c : option.key) {
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  return name;
}

std::string_view type_name(OptionType type) {
  switch (type) {
    case kEndpoint:
      return "HOST:PORT";
    case kPath:
      return "PATH";
    case kCount:
      return "N";
    case kSeconds:
      return "SECONDS";
    case kBytes:
      return "BYTES";
    case kPaths:
      return "PATH,...";
    case kNames:
      return "NAME,...";
  }
  return "";
}

}  // namespace vitrine
