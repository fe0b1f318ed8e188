// SPDX-License-Identifier: Apache-2.0
// What the daemon can be told, in the types that the code uses. The defaults are in the table of
// options.h alone.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "server/config/networks.h"

namespace vitrine {

struct Endpoint {
  std::string host;        // a numeric address
  std::uint16_t port = 0;  // 0: any free port
  std::string path = {};   // of a Unix socket, in place of both

  bool operator==(const Endpoint&) const = default;
};

// What one daemon of an installation does.
struct Roles {
  bool serve = false;  // answers visitors and operators
  bool build = false;  // makes models of uploads
  bool scan = false;   // drives the scanners
};

struct Settings {
  Endpoint listen;
  Endpoint admin_listen;
  Roles roles;
  std::filesystem::path data;
  std::filesystem::path uploads;  // empty: in the data folder
  std::string store, catalogue;   // URLs; empty: in the data folder
  std::string store_access_key, store_secret_key;
  std::filesystem::path port_file;        // empty: none is written
  std::filesystem::path admin_port_file;  // empty: none is written
  std::filesystem::path access_log;       // "-": standard error; empty: none
  std::uint32_t threads = 0;              // 0: one per core
  std::uint32_t max_connections = 0;
  std::chrono::seconds idle_timeout{};  // for a whole request header, and for each write to advance
  std::chrono::seconds stop_timeout{};  // from SIGTERM to the end
  std::uint64_t export_cache_bytes = 0;
  std::uint64_t model_cache_bytes = 0;
  std::uint64_t answer_memory_bytes = 0;
  std::vector<std::string> allowed_origins;  // "https://museum.example"
  std::uint64_t max_upload_bytes = 0;
  std::uint32_t max_uploads = 0;                // open at a time, of one token
  std::chrono::seconds upload_lifetime{};       // since its last piece
  std::chrono::seconds collect_after{};         // that an object stays which nothing names
  std::uint64_t quota_bytes = 0;                // of models and uploads; 0: none
  std::vector<std::string> webhook_hosts;       // host or host:port
  std::vector<std::filesystem::path> scanners;  // their rig.json files
  std::string scan_address;  // where other daemons reach them, no slash at its end; empty: nowhere
  std::filesystem::path tls_certificate;  // empty: no TLS
  std::filesystem::path tls_key;
  Networks trusted_proxies;
  std::uint32_t max_connections_per_address = 0;
  std::uint32_t request_rate = 0;  // a second, of each address and token; 0: no limit
  std::uint32_t min_rate = 0;      // bytes a second that the reader of an answer takes at least
  std::string public_url;  // what addresses begin with, no slash at its end; empty: the request's
};

}  // namespace vitrine
