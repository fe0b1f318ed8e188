// SPDX-License-Identifier: Apache-2.0
// The daemon's settings as typed values. Only the table in options.cpp defines their defaults.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/config/networks.h"

namespace vitrine::server {

struct Endpoint {
  std::string host;        // a numeric address
  std::uint16_t port = 0;  // 0: any free port
  std::string path = {};   // path of a Unix socket, used instead of host and port

  bool operator==(const Endpoint&) const = default;
};

// The roles of one daemon of an installation.
struct Roles {
  bool serves = false;  // whether the daemon answers visitors and operators
  bool builds = false;  // whether the daemon builds models from uploads
  bool scans = false;   // whether the daemon drives the scanners
};

// A number of connections, or a percentage of the setting max-connections.
struct ConnectionShare {
  std::uint32_t value = 0;  // 0: no limit
  bool is_percentage = false;

  bool operator==(const ConnectionShare&) const = default;
};

// Returns the number of connections that a share allows: at least 1, or SIZE_MAX if there is no
// limit.
inline std::size_t connections_of(const ConnectionShare& share, std::size_t max_connections) {
  if (share.value == 0) return SIZE_MAX;
  if (!share.is_percentage) return share.value;
  return std::max<std::size_t>(1, max_connections * share.value / 100);
}

struct Settings {
  Endpoint listen;
  Endpoint admin_listen;
  Roles roles;
  std::filesystem::path data;
  std::filesystem::path uploads;  // empty: a folder in the data folder
  // URLs of the object store and the catalogue. If a URL is empty, the data folder is used.
  std::string store, catalogue;
  std::string store_access_key, store_secret_key;
  std::filesystem::path port_file;        // empty: no such file is written
  std::filesystem::path admin_port_file;  // empty: no such file is written
  std::filesystem::path access_log;       // "-": standard error; empty: no log
  std::uint64_t access_log_bytes = 0;     // size at which the log is replaced; 0: never
  bool shortens_addresses = false;        // whether logs name networks instead of addresses
  bool counts_visits = false;             // whether the daemon counts visits to models
  std::uint32_t threads = 0;              // 0: one per core
  std::uint32_t max_connections = 0;
  // Time limit for receiving a whole request header, and for a write that makes no progress.
  std::chrono::seconds idle_timeout{};
  std::chrono::seconds stop_timeout{};  // longest time from SIGTERM to the end of the process
  std::uint64_t export_cache_bytes = 0;
  std::uint64_t model_cache_bytes = 0;
  std::uint64_t answer_memory_bytes = 0;
  std::vector<std::string> hosts;            // own host names, such as "museum.example"
  std::vector<std::string> allowed_origins;  // such as "https://museum.example"
  std::uint64_t max_upload_bytes = 0;
  std::uint32_t max_uploads = 0;  // largest number of uploads that a token may have open
  // How long an upload is kept after its last part was received.
  std::chrono::seconds upload_lifetime{};
  std::chrono::seconds collect_after{};  // age at which an unreferenced object is removed
  std::uint64_t quota_bytes = 0;  // limit on the size of models and uploads together; 0: no limit
  std::uint64_t scrub_rate = 0;   // bytes per second of the background check; 0: no check
  std::uint64_t disk_reserve_bytes = 0;    // free space below which a disk counts as nearly full
  std::vector<std::string> webhook_hosts;  // allowed for webhooks: "host" or "host:port"
  std::string webhook_key;  // bytes of the key that signs webhooks; empty: they are not signed
  std::vector<std::string> purge_urls;          // URLs of caches to purge, without a final slash
  std::vector<std::filesystem::path> scanners;  // paths of rig.json files
  // URL at which other daemons reach this daemon, without a slash at its end. Empty if other
  // daemons cannot reach it.
  std::string scan_address;
  std::filesystem::path tls_certificate;  // empty: the daemon does not use TLS
  std::filesystem::path tls_key;
  Networks trusted_proxies;
  ConnectionShare max_connections_per_address;
  // Requests per second that each address and each token may send. 0: no limit.
  std::uint32_t request_rate = 0;
  // Bytes per second that a client must receive on average; 0: no minimum.
  std::uint32_t min_rate = 0;
  // Start of all absolute URLs, without a slash at its end. If it is empty, the Host field of each
  // request determines the start.
  std::string public_url;
  // E-mail address of the people who run this installation. Empty: OAI-PMH states webmaster@ and
  // the host.
  std::string contact;
};

}  // namespace vitrine::server
