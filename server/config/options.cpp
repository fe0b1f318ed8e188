// SPDX-License-Identifier: Apache-2.0
#include "server/config/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>

#include "codec/core/parse_number.h"
#include "server/config/endpoint.h"
#include "server/config/host_names.h"
#include "server/config/webhook_key.h"

namespace vitrine::server {
namespace {

Expected<std::uint64_t> parse_within(std::string_view text, std::uint64_t min, std::uint64_t max) {
  const auto value = parse_number<std::uint64_t>(text);
  if (!value || *value < min || *value > max) {
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is not a whole number from {} to {}; correct it", text, min, max));
  }
  return *value;
}

template <auto Member>
Expected<void> endpoint(Settings& settings, std::string_view text) {
  auto value = parse_endpoint(text);
  if (!value) return tl::unexpected(value.error());
  settings.*Member = std::move(*value);
  return {};
}

template <auto Member>
Expected<void> path(Settings& settings, std::string_view text) {
  settings.*Member = std::filesystem::path(text);
  return {};
}

// Replaces `list` by the parts of "A,B,…". `missing` is the error message if a part is empty.
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

Expected<void> origins(Settings& settings, std::string_view text) {
  if (auto done = parse_list(settings.allowed_origins, text,
                             "an origin in the list is empty; remove the extra comma");
      !done)
    return done;
  for (const std::string& origin : settings.allowed_origins) {
    if (is_origin(origin)) continue;
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is not an origin; give, for example, https://museum.example", origin));
  }
  return {};
}

Expected<void> hosts(Settings& settings, std::string_view text) {
  if (auto done =
          parse_list(settings.hosts, text, "a host in the list is empty; remove the extra comma");
      !done)
    return done;
  for (const std::string& host : settings.hosts) {
    if (is_host_name(host)) continue;
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a host name; give, for example, museum.example", host));
  }
  return {};
}

Expected<void> contact(Settings& settings, std::string_view text) {
  const std::size_t at = std::min(text.find('@'), text.size());
  const std::string_view host = text.substr(std::min(at + 1, text.size()));
  const bool is_mail = at > 0 && host.find('.') != host.npos && host.find("..") == host.npos &&
                       host.front() != '.' && host.back() != '.' &&
                       std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7F; });
  if (!text.empty() && !is_mail) {
    return fail(
        ErrorCode::kBadInput,
        fmt::format("'{}' is not an e-mail address; give, for example, 3d@museum.example", text));
  }
  settings.contact = text;
  return {};
}

Expected<void> scanners(Settings& settings, std::string_view text) {
  return parse_list(settings.scanners, text, "a path in the list is empty; remove the extra comma");
}

Expected<void> webhook_hosts(Settings& settings, std::string_view text) {
  return parse_list(settings.webhook_hosts, text,
                    "a host in the list is empty; remove the extra comma");
}

Expected<void> webhook_secret(Settings& settings, std::string_view text) {
  auto key = webhook_key(text);
  if (!key) return tl::unexpected(key.error());
  settings.webhook_key = std::move(*key);
  return {};
}

Expected<void> roles(Settings& settings, std::string_view text) {
  std::vector<std::string_view> names;
  if (auto done = parse_list(names, text, "a role in the list is empty; remove the extra comma");
      !done)
    return done;
  settings.roles = {};
  for (const std::string_view name : names) {
    bool* const role = name == "serve"   ? &settings.roles.serves
                       : name == "build" ? &settings.roles.builds
                       : name == "scan"  ? &settings.roles.scans
                                         : nullptr;
    if (role == nullptr) {
      return fail(
          ErrorCode::kBadInput,
          fmt::format("'{}' is not a role; give one or more of serve, build and scan", name));
    }
    *role = true;
  }
  if (!names.empty()) return {};
  return fail(ErrorCode::kBadInput, "the list is empty; give one or more of serve, build and scan");
}

Expected<void> log_addresses(Settings& settings, std::string_view text) {
  if (text != "full" && text != "short") {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a form of addresses; give full or short", text));
  }
  settings.shortens_addresses = text == "short";
  return {};
}

Expected<void> count_visits(Settings& settings, std::string_view text) {
  if (text != "yes" && text != "no")
    return fail(ErrorCode::kBadInput, fmt::format("'{}' is neither yes nor no; give one", text));
  settings.counts_visits = text == "yes";
  return {};
}

Expected<void> trusted_proxies(Settings& settings, std::string_view text) {
  auto networks = Networks::parse(text);
  if (!networks) return tl::unexpected(networks.error());
  settings.trusted_proxies = std::move(*networks);
  return {};
}

Expected<void> data_folder(Settings& settings, std::string_view text) {
  if (text.empty()) return fail(ErrorCode::kBadInput, "the path is empty; name the data folder");
  return path<&Settings::data>(settings, text);
}

template <auto Member, std::uint64_t Min, std::uint64_t Max>
Expected<void> number(Settings& settings, std::string_view text) {
  const auto value = parse_within(text, Min, Max);
  if (!value) return tl::unexpected(value.error());
  using Number = std::remove_reference_t<decltype(settings.*Member)>;
  settings.*Member = static_cast<Number>(*value);
  return {};
}

Expected<void> connection_share(Settings& settings, std::string_view text) {
  const bool is_percentage = text.ends_with('%');
  const auto value = is_percentage ? parse_within(text.substr(0, text.size() - 1), 1, 100)
                                   : parse_within(text, 0, 1'000'000);
  if (!value) return tl::unexpected(value.error());
  settings.max_connections_per_address = {static_cast<std::uint32_t>(*value), is_percentage};
  return {};
}

// Reads a URL. Error messages do not contain the URL, because it may contain a password.
template <auto Member>
Expected<void> url_of(Settings& settings, std::string_view text,
                      std::initializer_list<std::string_view> schemes) {
  const bool fits = std::ranges::any_of(
      schemes, [text](std::string_view scheme) { return text.starts_with(scheme); });
  if (!text.empty() && !fits) {
    return fail(ErrorCode::kBadInput,
                fmt::format("the URL does not begin with {}; correct it", *schemes.begin()));
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

// Reads the URL of a server, without slashes at its end. It may have a path, for use by a proxy.
Expected<std::string> server_url(std::string_view text) {
  while (text.ends_with('/'))
    text.remove_suffix(1);
  const std::size_t scheme = text.starts_with("https://") ? 8 : text.starts_with("http://") ? 7 : 0;
  const auto fits = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-._~:/[]").find(c) != std::string_view::npos;
  };
  if (scheme == 0 || text.size() == scheme || !std::ranges::all_of(text, fits)) {
    return fail(ErrorCode::kBadInput,
                fmt::format("'{}' is not a URL; give, for example, https://museum.example", text));
  }
  return std::string(text);
}

template <auto Member>
Expected<void> address(Settings& settings, std::string_view text) {
  if (text.empty()) return text_of<Member>(settings, text);
  auto url = server_url(text);
  if (!url) return tl::unexpected(url.error());
  settings.*Member = std::move(*url);
  return {};
}

Expected<void> purge_urls(Settings& settings, std::string_view text) {
  if (auto done = parse_list(settings.purge_urls, text,
                             "a URL in the list is empty; remove the extra comma");
      !done)
    return done;
  for (std::string& cache : settings.purge_urls) {
    auto url = server_url(cache);
    if (!url) return tl::unexpected(url.error());
    cache = std::move(*url);
  }
  return {};
}

using S = Settings;
using enum OptionType;

constexpr std::array kOptions{
    Option{.key = "listen",
           .type = kEndpoint,
           .default_value = "127.0.0.1:8080",
           .doc = "Numeric IP address, or localhost, and port for visitors. Port 0: any free port; "
                  "unix:/PATH: a Unix socket.",
           .apply = endpoint<&S::listen>},
    Option{.key = "tls-certificate",
           .type = kPath,
           .default_value = "",
           .doc = "PEM file of the certificate chain for TLS on 'listen'. Empty: no TLS. "
                  "Certificate and key are read again when they change.",
           .apply = path<&S::tls_certificate>},
    Option{.key = "tls-key",
           .type = kPath,
           .default_value = "",
           .doc = "PEM file of the certificate's private key, without a passphrase.",
           .apply = path<&S::tls_key>},
    Option{.key = "trusted-proxies",
           .type = kNetworks,
           .default_value = "",
           .doc = "Proxies whose X-Forwarded-For, X-Forwarded-Proto and Forwarded fields are "
                  "trusted: addresses, networks such as 10.0.0.0/8, or unix for clients on a Unix "
                  "socket.",
           .apply = trusted_proxies},
    Option{.key = "data",
           .type = kPath,
           .default_value = "./data",
           .doc = "Folder for model files (objects) and the catalogue.",
           .apply = data_folder},
    Option{
        .key = "roles",
        .type = kNames,
        .default_value = "serve,build,scan",
        .doc =
            "Tasks of this daemon: serve (answer requests on 'listen'), build (build models from "
            "uploads), scan (drive scanners). Daemons that share store, catalogue and uploads "
            "can divide the roles.",
        .apply = roles},
    Option{.key = "uploads",
           .type = kPath,
           .default_value = "",
           .doc = "Folder for uploads in progress. All daemons that serve or build must use the "
                  "same folder. Empty: in the data folder.",
           .apply = path<&S::uploads>},
    Option{.key = "store",
           .type = kUrl,
           .default_value = "",
           .doc = "S3-compatible bucket: s3://BUCKET[/PREFIX][?endpoint=URL&region=R&style=S]. R: "
                  "default us-east-1. S says where URLs name the bucket: path (default with an "
                  "endpoint) or virtual (in the host name; default without an endpoint). Empty: "
                  "objects are in the data folder.",
           .apply = store_url},
    Option{.key = "store-access-key",
           .type = kText,
           .default_value = "",
           .doc = "Access key ID for the S3-compatible object store.",
           .apply = text_of<&S::store_access_key>},
    Option{.key = "store-secret-key",
           .type = kText,
           .default_value = "",
           .doc = "Secret access key for the object store. Set it in the file or the environment.",
           .is_secret = true,
           .apply = text_of<&S::store_secret_key>},
    Option{.key = "catalogue",
           .type = kUrl,
           .default_value = "",
           .doc = "PostgreSQL for the catalogue (models, tokens, jobs): "
                  "postgresql://USER:PASSWORD@HOST/DATABASE?LIBPQ_OPTIONS. Set it in the file or "
                  "the environment. Empty: a file in the data folder.",
           .is_secret = true,
           .apply = catalogue_url},
    Option{.key = "port-file",
           .type = kPath,
           .default_value = "",
           .doc = "File to write the port of 'listen' to once it is bound.",
           .apply = path<&S::port_file>},
    Option{.key = "admin-listen",
           .type = kEndpoint,
           .default_value = "127.0.0.1:0",
           .doc = "Address and port for /livez, /readyz and /metrics. Keep it off public networks.",
           .apply = endpoint<&S::admin_listen>},
    Option{.key = "admin-port-file",
           .type = kPath,
           .default_value = "",
           .doc = "File to write the port of 'admin-listen' to once it is bound.",
           .apply = path<&S::admin_port_file>},
    Option{.key = "access-log",
           .type = kPath,
           .default_value = "-",
           .doc =
               "File for the access log, one line per request. '-' is standard error, whose size "
               "'access-log-size' does not limit; empty disables the log.",
           .apply = path<&S::access_log>,
           .is_reloadable = true},
    Option{.key = "access-log-size",
           .type = kBytes,
           .default_value = "1073741824",
           .doc = "Size at which the access log is renamed to FILE.old, replacing an older one, "
                  "and a new log is started. 0: never.",
           .apply = number<&S::access_log_bytes, 0, std::numeric_limits<std::uint64_t>::max()>,
           .is_reloadable = true},
    Option{.key = "log-addresses",
           .type = kAddressForm,
           .default_value = "full",
           .doc = "How logs show clients' addresses: full, or short (only the network: 24 bits of "
                  "an IPv4 address, 48 bits of an IPv6 address).",
           .apply = log_addresses},
    Option{.key = "count-visits",
           .type = kYesNo,
           .default_value = "yes",
           .doc = "Whether to count visits to published models. Only sums for each model and day "
                  "are stored: visits, seconds and levels of detail.",
           .apply = count_visits,
           .is_reloadable = true},
    Option{.key = "threads",
           .type = kCount,
           .default_value = "0",
           .doc = "Threads that serve connections. 0: one per core.",
           .apply = number<&S::threads, 0, 1024>},
    Option{.key = "max-connections",
           .type = kCount,
           .default_value = "10000",
           .doc = "Largest number of open connections. The daemon closes further ones at once.",
           .apply = number<&S::max_connections, 1, 1'000'000>,
           .is_reloadable = true},
    Option{
        .key = "max-connections-per-address",
        .type = kShare,
        .default_value = "10%",
        .doc =
            "Largest number of open connections from one address or IPv6 /64 network: a number, or "
            "a percentage of 'max-connections'. 0: no limit. Connections of trusted proxies are "
            "not limited, but each stream through a proxy counts for its client's address.",
        .apply = connection_share,
        .is_reloadable = true},
    Option{.key = "request-rate",
           .type = kCount,
           .default_value = "1000",
           .doc =
               "Requests per second allowed for each address (or IPv6 /64 network) and each token; "
               "ten times as many in a burst. Further requests get 429. Successful responses "
               "that need neither the catalogue nor a file, such as chunks of a model in "
               "'model-cache', do not count, but the access log leaves out those beyond the same "
               "rate. 0: no limit.",
           .apply = number<&S::request_rate, 0, 1'000'000>},
    Option{.key = "min-rate",
           .type = kBytes,
           .default_value = "256",
           .doc =
               "Disconnect clients that receive fewer bytes per second than this, on average. For "
               "responses that count towards 'answer-memory', the least rate is 2000, or 20000 "
               "if they take more than a 64th of it. 0 disables the check.",
           .apply = number<&S::min_rate, 0, 1'000'000'000>},
    Option{
        .key = "idle-timeout",
        .type = kSeconds,
        .default_value = "30",
        .doc = "Time that a client may take to send a request's header, or to accept more bytes.",
        .apply = number<&S::idle_timeout, 1, 3600>,
        .is_reloadable = true},
    Option{.key = "stop-timeout",
           .type = kSeconds,
           .default_value = "20",
           .doc = "Time that open transfers may take to finish after SIGTERM.",
           .apply = number<&S::stop_timeout, 0, 3600>,
           .is_reloadable = true},
    Option{.key = "export-cache",
           .type = kBytes,
           .default_value = "268435456",
           .doc = "Memory for exported files and poster images.",
           .apply = number<&S::export_cache_bytes, 0, std::numeric_limits<std::uint64_t>::max()>,
           .is_reloadable = true},
    Option{.key = "model-cache",
           .type = kBytes,
           .default_value = "268435456",
           .doc = "Memory for headers (manifests) of the most recently requested models.",
           .apply = number<&S::model_cache_bytes, 0, std::numeric_limits<std::uint64_t>::max()>,
           .is_reloadable = true},
    Option{.key = "answer-memory",
           .type = kBytes,
           .default_value = "536870912",
           .doc = "Memory for responses that clients have not received yet; responses from files "
                  "need none. A response that does not fit beside the others fails with 503. "
                  "Responses to one address may take a quarter; the first may be larger. The last "
                  "quarter is for addresses that take at most a 64th. A response larger than three "
                  "quarters fails with 507, and so does a range of it.",
           .apply = number<&S::answer_memory_bytes, 1, std::numeric_limits<std::uint64_t>::max()>,
           .is_reloadable = true},
    Option{.key = "hosts",
           .type = kNames,
           .default_value = "",
           .doc = "Host names, without ports, under which clients reach this daemon. Requests for "
                  "other names are refused (DNS rebinding), except numeric addresses, localhost "
                  "and the hosts of 'public-url' and 'scan-address'. If both 'hosts' and "
                  "'public-url' are empty, 'listen' accepts every name.",
           .apply = hosts,
           .is_reloadable = true},
    Option{.key = "allowed-origins",
           .type = kOrigins,
           .default_value = "",
           .doc = "Other web sites whose pages may open WebSockets here, and send requests with a "
                  "token, such as uploads. Empty: all may open WebSockets, but only without a "
                  "token.",
           .apply = origins,
           .is_reloadable = true},
    Option{.key = "max-upload",
           .type = kBytes,
           .default_value = "8589934592",
           .doc = "Largest size of an uploaded file.",
           .apply = number<&S::max_upload_bytes, 0, std::numeric_limits<std::int64_t>::max()>},
    Option{.key = "max-uploads",
           .type = kCount,
           .default_value = "16",
           .doc = "Largest number of unfinished uploads of one token.",
           .apply = number<&S::max_uploads, 1, 100'000>},
    Option{.key = "upload-lifetime",
           .type = kSeconds,
           .default_value = "86400",
           .doc = "Time to keep an upload after its last part, unless a job uses it.",
           .apply = number<&S::upload_lifetime, 1, 31'536'000>},
    Option{.key = "collect-after",
           .type = kSeconds,
           .default_value = "3600",
           .doc = "Time to keep a stored file that no model refers to.",
           .apply = number<&S::collect_after, 0, 31'536'000>},
    Option{.key = "scrub-rate",
           .type = kBytes,
           .default_value = "8000000",
           .doc = "Bytes per second that the background check of all stored files reads. It runs "
                  "when the daemon starts, and then weekly. 0 disables it.",
           .apply = number<&S::scrub_rate, 0, 1'000'000'000'000>},
    Option{.key = "quota",
           .type = kBytes,
           .default_value = "0",
           .doc = "Largest total size of all models and uploads; uploads beyond it are refused. "
                  "0: no limit.",
           .apply = number<&S::quota_bytes, 0, std::numeric_limits<std::int64_t>::max()>},
    Option{.key = "disk-reserve",
           .type = kBytes,
           .default_value = "1000000000",
           .doc = "Free space to keep on the disks of 'data' and 'uploads'; uploads that need it "
                  "are refused. /readyz and vitrine_disk_nearly_full report if less is free.",
           .apply = number<&S::disk_reserve_bytes, 0, std::numeric_limits<std::int64_t>::max()>,
           .is_reloadable = true},
    Option{.key = "webhook-hosts",
           .type = kNames,
           .default_value = "",
           .doc = "Servers that webhooks may call when jobs end: HOST or HOST:PORT, separated by "
                  "commas. Empty: webhooks are disabled.",
           .apply = webhook_hosts},
    Option{.key = "purge-urls",
           .type = kUrls,
           .default_value = "",
           .doc = "URLs of shared caches. For each chunk that is no longer public, the daemon "
                  "sends them PURGE URL/api/v1/chunks/SHA256.",
           .apply = purge_urls},
    Option{.key = "webhook-secret",
           .type = kText,
           .default_value = "",
           .doc = "Secret that signs webhooks, shared with their receivers: whsec_ and 24 to 64 "
                  "bytes in Base64. Set it in the file or the environment. Empty: webhooks are not "
                  "signed.",
           .is_secret = true,
           .apply = webhook_secret},
    Option{.key = "scanners",
           .type = kPaths,
           .default_value = "",
           .doc = "Configuration files (rig.json) of the scanners that this daemon drives.",
           .apply = scanners},
    Option{.key = "scan-address",
           .type = kUrl,
           .default_value = "",
           .doc = "URL under which other daemons reach 'listen' of this daemon, for example "
                  "http://10.0.0.7:8080. They forward requests for its scanners there. Empty: they "
                  "cannot reach its scanners.",
           .apply = address<&S::scan_address>},
    Option{.key = "public-url",
           .type = kUrl,
           .default_value = "",
           .doc = "URL prefix that visitors see, if a proxy changes it: https://museum.example. "
                  "Empty: taken from the Host field of each request.",
           .apply = address<&S::public_url>,
           .is_reloadable = true},
    Option{.key = "contact",
           .type = kText,
           .default_value = "",
           .doc = "E-mail address of the operators, which OAI-PMH states to harvesters. Empty: "
                  "webmaster@ and the host of 'public-url'.",
           .apply = contact,
           .is_reloadable = true},
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
    case kShare:
      return "N|N%";
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
    case kUrls:
      return "URL,...";
    case kText:
      return "TEXT";
    case kAddressForm:
      return "full|short";
    case kYesNo:
      return "yes|no";
    case kNames:
      return "NAME,...";
    case kNetworks:
      return "NETWORK,...";
  }
  return "";
}

}  // namespace vitrine::server
