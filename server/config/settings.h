// SPDX-License-Identifier: Apache-2.0
// The daemon's settings as typed values. Their defaults are only in the table in options.cpp.
#pragma once

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
  bool serves = false;  // answers visitors and operators
  bool builds = false;  // builds models from uploads
  bool scans = false;   // drives the scanners
};

struct Settings {
  Endpoint listen;
  Endpoint admin_listen;
  Roles roles;
  std::filesystem::path data;
  std::filesystem::path uploads;  // empty: in the data folder
  std::string store, catalogue;   // URLs; an empty one means the data folder
  std::string store_access_key, store_secret_key;
  std::filesystem::path port_file;        // empty: no such file is written
  std::filesystem::path admin_port_file;  // empty: no such file is written
  std::filesystem::path access_log;       // "-": standard error; empty: no log
  std::uint32_t threads = 0;              // 0: one per core
  std::uint32_t max_connections = 0;
  // Longest time to receive a whole request header, and longest time that a write may make no
  // progress.
  std::chrono::seconds idle_timeout{};
  std::chrono::seconds stop_timeout{};  // longest time from SIGTERM to the end of the process
  std::uint64_t export_cache_bytes = 0;
  std::uint64_t model_cache_bytes = 0;
  std::uint64_t answer_memory_bytes = 0;
  std::vector<std::string> allowed_origins;  // such as "https://museum.example"
  std::uint64_t max_upload_bytes = 0;
  std::uint32_t max_uploads = 0;  // uploads that a token may have open at a time
  // How long an upload is kept after its last part was received.
  std::chrono::seconds upload_lifetime{};
  std::chrono::seconds collect_after{};  // age at which an unreferenced object is removed
  std::uint64_t quota_bytes = 0;  // limit on the size of models and uploads together; 0: no limit
  std::vector<std::string> webhook_hosts;       // entries are "host" or "host:port"
  std::vector<std::filesystem::path> scanners;  // paths of rig.json files
  // URL under which other daemons reach this daemon, without a slash at its end. Empty if they
  // cannot.
  std::string scan_address;
  std::filesystem::path tls_certificate;  // empty: the daemon does not use TLS
  std::filesystem::path tls_key;
  Networks trusted_proxies;
  std::uint32_t max_connections_per_address = 0;
  // Requests per second of each address and of each token. 0: no limit.
  std::uint32_t request_rate = 0;
  // Bytes per second that a client must receive on average; 0: no minimum.
  std::uint32_t min_rate = 0;
  // Prefix of all URLs, without a slash at its end. If it is empty, the prefix is taken from the
  // request.
  std::string public_url;
};

}  // namespace vitrine::server
