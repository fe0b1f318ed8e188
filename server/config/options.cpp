// SPDX-License-Identifier: Apache-2.0
#include "server/config/options.h"

#include <fmt/format.h>
#include <sys/un.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

#include "codec/core/parse_number.h"

namespace vitrine {
namespace {

Expected<std::uint64_t> parse_within(std::string_view text, std::uint64_t min, std::uint64_t max) {
  const auto value = parse_number<std::uint64_t>(text);
  if (!value || *value < min || *value > max) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a whole number from {} to {}; give one", text, min, max));
  }
  return *value;
}

Expected<Endpoint> parse_unix_socket(std::string_view path) {
  if (path.empty() || path.size() >= sizeof(sockaddr_un::sun_path)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not the path of a socket, 1 to {} bytes; give one", path,
                            sizeof(sockaddr_un::sun_path) - 1));
  }
  return Endpoint{.path = std::string(path)};
}

Expected<Endpoint> parse_endpoint(std::string_view text) {
  constexpr std::string_view kUnix = "unix:";
  if (text.starts_with(kUnix)) return parse_unix_socket(text.substr(kUnix.size()));
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not HOST:PORT; give, for example, 127.0.0.1:8080", text));
  }
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  if (host == "localhost") host = "127.0.0.1";
  if (!is_address(host.substr(0, host.find('%')))) {  // without the zone of fe80::1%eth0
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is not a numeric address; give, for example, 127.0.0.1 or [::1]", host));
  }
  const auto port = parse_within(text.substr(colon + 1), 0, 65535);
  if (!port) return Unexpected(port.error());
  return Endpoint{.host = std::string(host), .port = static_cast<std::uint16_t>(*port)};
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

// As browsers write it: scheme, host in lower case, the port where it is not the scheme's.
bool is_origin(std::string_view text) {
  const std::size_t scheme = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : 0;
  const std::string_view host = text.substr(scheme);
  return scheme > 0 && !host.empty() && std::ranges::all_of(host, [](unsigned char c) {
           return std::islower(c) || std::isdigit(c) ||
                  std::string_view("-.:[]").find(static_cast<char>(c)) != std::string_view::npos;
         });
}

Expected<void> origins(Settings& settings, std::string_view text) {
  if (auto done = parse_list(settings.allowed_origins, text, "an origin in it is empty"); !done)
    return done;
  for (const std::string& origin : settings.allowed_origins) {
    if (is_origin(origin)) continue;
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is no origin; give, for example, https://museum.example", origin));
  }
  return {};
}

Expected<void> scanners(Settings& settings, std::string_view text) {
  return parse_list(settings.scanners, text, "a path in it is empty; name the rig.json");
}

Expected<void> webhook_hosts(Settings& settings, std::string_view text) {
  return parse_list(settings.webhook_hosts, text, "a host in it is empty; name the server");
}

Expected<void> roles(Settings& settings, std::string_view text) {
  std::vector<std::string_view> names;
  if (auto done = parse_list(names, text, "a role in it is empty; name one"); !done) return done;
  settings.roles = {};
  for (const std::string_view name : names) {
    bool* const role = name == "serve"   ? &settings.roles.serve
                       : name == "build" ? &settings.roles.build
                       : name == "scan"  ? &settings.roles.scan
                                         : nullptr;
    if (role == nullptr) {
      return fail(ErrorCode::kBadInput,
                  fmt::format("'{}' is no role; give some of serve, build and scan", name));
    }
    *role = true;
  }
  if (!names.empty()) return {};
  return fail(ErrorCode::kBadInput, "it is empty; give some of serve, build and scan");
}

Expected<void> trusted_proxies(Settings& settings, std::string_view text) {
  auto networks = Networks::parse(text);
  if (!networks) return Unexpected(networks.error());
  settings.trusted_proxies = std::move(*networks);
  return {};
}

Expected<void> data_folder(Settings& settings, std::string_view text) {
  if (text.empty()) return fail(ErrorCode::kBadInput, "it is empty; name the data folder");
  return path<&Settings::data>(settings, text);
}

template <auto Member, std::uint64_t Min, std::uint64_t Max>
Expected<void> number(Settings& settings, std::string_view text) {
  const auto value = parse_within(text, Min, Max);
  if (!value) return Unexpected(value.error());
  using Target = std::remove_reference_t<decltype(settings.*Member)>;
  settings.*Member = static_cast<Target>(*value);
  return {};
}

// The message does not repeat the URL, which may hold a password.
template <auto Member>
Expected<void> url_of(Settings& settings, std::string_view text,
                      std::initializer_list<std::string_view> schemes) {
  const bool fits = std::ranges::any_of(
      schemes, [text](std::string_view scheme) { return text.starts_with(scheme); });
  if (!text.empty() && !fits) {
    return fail(ErrorCode::kBadInput,
                fmt::format("it does not begin with {}; correct the URL", *schemes.begin()));
  }
  settings.*Member = std::string(text);
  return {};
}

Expected<void> store_url(Settings& settings, std::string_view text) {
  return url_of<&Settings::store>(settings, text, {"s3://"});
}

Expected<void> catalogue_url(Settings& settings, std::string_view text) {
  return url_of<&Settings::catalogue>(settings, text, {"postgresql://", "postgres://"});
}

template <auto Member>
Expected<void> text_of(Settings& settings, std::string_view text) {
  settings.*Member = std::string(text);
  return {};
}

// An origin and, behind a proxy that adds one, a path; what a browser would show.
template <auto Member>
Expected<void> address(Settings& settings, std::string_view text) {
  while (text.ends_with('/'))
    text.remove_suffix(1);
  const std::size_t scheme = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : 0;
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-._~:/[]").find(c) != std::string_view::npos;
  };
  if (!text.empty() && (scheme == 0 || text.size() == scheme || !std::ranges::all_of(text, fits))) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is no URL; give, for example, https://museum.example", text));
  }
  settings.*Member = std::string(text);
  return {};
}

using S = Settings;
constexpr bool kReloadable = true;
using enum OptionType;

constexpr std::array kOptions{
    Option{"listen", kEndpoint, "127.0.0.1:8080",
           "Where visitors connect. Port 0 takes any free port; unix:/PATH is a Unix socket.",
           false, endpoint<&S::listen>},
    Option{
        "tls-certificate", kPath, "",
        "The certificate chain (PEM) that 'listen' speaks TLS with; empty is without TLS. It and "
        "the key are read again when they change.",
        false, path<&S::tls_certificate>},
    Option{"tls-key", kPath, "", "The certificate's private key (PEM).", false, path<&S::tls_key>},
    Option{"trusted-proxies", kNetworks, "",
           "Whose X-Forwarded-For, X-Forwarded-Proto and Forwarded are believed: addresses, "
           "networks, or unix.",
           false, trusted_proxies},
    Option{"data", kPath, "./data", "The folder of this installation: objects and catalogue.",
           false, data_folder},
    Option{
        "roles", kNames, "serve,build,scan",
        "What this daemon does: answer on 'listen', make models of uploads, drive scanners. What "
        "is left out another does that has the same store, catalogue and uploads.",
        false, roles},
    Option{"uploads", kPath, "",
           "The folder of what is being uploaded; all that serve or build share one. Empty: in the "
           "data folder.",
           false, path<&S::uploads>},
    Option{
        "store", kUrl, "",
        "A bucket that holds the objects: s3://BUCKET/PREFIX?endpoint=URL&region=R&style=path, or "
        "style=virtual. Empty: in the data folder.",
        false, store_url},
    Option{"store-access-key", kText, "", "Who this daemon is for the object store.", false,
           text_of<&S::store_access_key>},
    Option{"store-secret-key", kText, "", "What proves it. Set it in the file or environment.",
           true, text_of<&S::store_secret_key>},
    Option{"catalogue", kUrl, "",
           "A PostgreSQL database: postgresql://USER:PASSWORD@HOST/DATABASE, with what else libpq "
           "knows. Set it in the file or environment. Empty: a file in the data folder.",
           true, catalogue_url},
    Option{"port-file", kPath, "", "A file to write the port of 'listen' to once it is bound.",
           false, path<&S::port_file>},
    Option{"admin-listen", kEndpoint, "127.0.0.1:0",
           "Where /livez, /readyz and /metrics are. Keep it off public networks.", false,
           endpoint<&S::admin_listen>},
    Option{"admin-port-file", kPath, "",
           "A file to write the port of 'admin-listen' to once it is bound.", false,
           path<&S::admin_port_file>},
    Option{"access-log", kPath, "-", "One line per request. '-' is standard error; empty is none.",
           false, path<&S::access_log>, kReloadable},
    Option{"threads", kCount, "0", "Threads that serve connections. 0 is one per core.", false,
           number<&S::threads, 0, 1024>},
    Option{"max-connections", kCount, "10000", "Connections beyond this number are closed at once.",
           false, number<&S::max_connections, 1, 1'000'000>, kReloadable},
    Option{
        "max-connections-per-address", kCount, "5000",
        "Likewise of one address, or of one IPv6 network of 64 bits, that is no trusted proxy's; "
        "streams count for the visitor behind the proxy. 0 is no limit.",
        false, number<&S::max_connections_per_address, 0, 1'000'000>},
    Option{"request-rate", kCount, "1000",
           "Requests a second that each address (of IPv6, each network of 64 bits) and each token "
           "may make beyond what is answered "
           "from memory, ten seconds' worth at once. 0 is no limit.",
           false, number<&S::request_rate, 0, 1'000'000>},
    Option{"min-rate", kBytes, "256",
           "Bytes a second that a reader takes on average, or it is cut. 0 is no limit.", false,
           number<&S::min_rate, 0, 1'000'000'000>},
    Option{"idle-timeout", kSeconds, "30",
           "How long a connection may take for a request's header, or to accept more bytes.", false,
           number<&S::idle_timeout, 1, 3600>, kReloadable},
    Option{"stop-timeout", kSeconds, "20",
           "After SIGTERM, how long transfers may take to finish before they are cut.", false,
           number<&S::stop_timeout, 0, 3600>, kReloadable},
    Option{"export-cache", kBytes, "268435456",
           "Memory for exported files and posters that are kept ready.", false,
           number<&S::export_cache_bytes, 0, std::numeric_limits<std::uint64_t>::max()>,
           kReloadable},
    Option{"model-cache", kBytes, "268435456",
           "Memory for what is known of the models that are asked for most recently.", false,
           number<&S::model_cache_bytes, 0, std::numeric_limits<std::uint64_t>::max()>,
           kReloadable},
    Option{
        "answer-memory", kBytes, "536870912",
        "Memory that answers may hold which their readers have not taken yet; beyond it they are "
        "503, and 507 where one alone is larger. What is sent from a file holds none.",
        false, number<&S::answer_memory_bytes, 1, std::numeric_limits<std::uint64_t>::max()>,
        kReloadable},
    Option{"allowed-origins", kOrigins, "",
           "The sites whose pages may open streams besides this one's. Empty: every site's, but "
           "with a token none's.",
           false, origins, kReloadable},
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
    Option{"scan-address", kUrl, "",
           "Where other daemons reach 'listen' of this one, which drives scanners: "
           "http://10.0.0.7:8080. They pass on what is asked of those. Empty: they do not.",
           false, address<&S::scan_address>},
    Option{
        "public-url", kUrl, "",
        "What visitors' addresses begin with, where a proxy changes that: https://museum.example. "
        "Empty: what each request says.",
        false, address<&S::public_url>, kReloadable},
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
    case kOrigins:
      return "ORIGIN,...";
    case kUrl:
      return "URL";
    case kText:
      return "TEXT";
    case kNames:
      return "NAME,...";
    case kNetworks:
      return "NETWORK,...";
  }
  return "";
}

}  // namespace vitrine
