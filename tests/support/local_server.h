// SPDX-License-Identifier: Apache-2.0
// Serves a test's own routes in this process, with one thread for all connections.
#pragma once

#include <algorithm>
#include <array>
#include <fstream>
#include <future>
#include <iterator>
#include <thread>

#include "server/api/api_route.h"
#include "server/api/path_parameters.h"
#include "server/api/services.h"
#include "server/http/http_server.h"
#include "server/jobs/publish_jobs.h"
#include "server/store/installation.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

// Returns the bytes of a string literal, for a WebAsset.
template <std::size_t kSize>
consteval std::array<std::uint8_t, kSize - 1> bytes_of(const char (&text)[kSize]) {
  std::array<std::uint8_t, kSize - 1> bytes{};
  std::copy_n(text, bytes.size(), bytes.begin());
  return bytes;
}

class LocalServer {
 public:
  explicit LocalServer(std::span<const ApiRoute> routes,
                       std::chrono::seconds idle_timeout = std::chrono::seconds(30),
                       std::vector<std::unique_ptr<ScannerBackend>> scanners = {},
                       HttpOptions options = {}, const ScannerClaims* claims = nullptr,
                       std::size_t max_exports = 1)
      : scans_({*installation_.store,
                *installation_.catalogue,
                *installation_.jobs,
                log_,
                folder_.path(),
                VITRINE_BIN_DIR "/vitrined",
                no_reserve,
                std::chrono::seconds(10),
                [this](JobRun& run) { return publishing_.work(run); },
                &quota_,
                {},
                claims},
               std::move(scanners)),
        metrics_(path_templates(routes)),
        workers_({.threads = 2,
                  .waiting_threads = Services::kWaitingThreads,
                  .urgent_threads = Services::kUrgentThreads,
                  .max_computations = max_exports}),
        server_(io_,
                {.tokens = tokens_,
                 .workers = workers_,
                 .metrics = metrics_,
                 .access_log = log_,
                 .events = events_},
                with(bind(routes, services_), idle_timeout, std::move(options))),
        port_(server_.listen({"127.0.0.1", 0}).value()) {
    server_.start();
    thread_ = std::thread([this] { io_.run(); });
  }
  ~LocalServer() {
    io_.stop();
    thread_.join();
    scans_.stop();
    workers_.stop();
    workers_.join();
  }

  std::uint16_t port() const { return port_; }
  Services& services() { return services_; }
  ScanService& scans() { return scans_; }
  const std::filesystem::path& data() const { return folder_.path(); }
  JobCatalogue& jobs() { return *installation_.jobs; }
  Catalogue& catalogue() { return *installation_.catalogue; }
  sql::Database& database() { return *installation_.database; }
  Workers& workers() { return workers_; }
  Collector& collector() { return collector_; }
  Scrubber& scrubber() { return scrubber_; }
  Uploads& uploads() { return uploads_; }
  ObjectStore& store() { return *installation_.store; }
  LiveSettings& settings() { return settings_; }
  const Metrics& metrics() const { return metrics_; }

  // Creates a token. Returns the header line "Authorization: Bearer ...\r\n" with it.
  std::string bearer(Role role) {
    return "Authorization: Bearer " + create_token(catalogue(), role, "").value().text + "\r\n";
  }
  // Returns the operator's log. The line of a connection's newest request may be missing.
  std::string events() const {
    std::ifstream in(folder_.path() / "events.log");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  Pace pace_of(const Body& body) const { return server_.pace_of(body); }
  void sweep() { server_.sweep(); }
  // Returns a future that becomes ready when no connection is open.
  std::future<void> drain() {
    const auto empty = std::make_shared<std::promise<void>>();
    server_.drain([empty] { empty->set_value(); });
    return empty->get_future();
  }

 private:
  static HttpOptions with(std::vector<Route> routes, std::chrono::seconds idle_timeout,
                          HttpOptions options) {
    options.routes = std::move(routes);
    options.parameters = parameter_patterns();
    options.max_connections = 64;
    options.idle_timeout = idle_timeout;
    return options;
  }

  using NoFaults = Expected<std::vector<std::string>>;
  static constexpr std::uint8_t kPlain[] = {'p', 'l', 'a', 'i', 'n'}, kPacked[] = {'g', 'z'};
  static constexpr std::string_view kHtml = "text/html; charset=utf-8";
  // The elements of web/src/gallery/index.html into which the server inserts texts.
  static constexpr auto kGallery =
      bytes_of("<head><title></title></head><h1 id=\"title\"></h1><ul id=\"models\"></ul>");
  static constexpr WebAsset kPages[] = {{"/model.html", kHtml, {}},
                                        {"/index.html", kHtml, kGallery},
                                        {"/console.html", kHtml, {}},
                                        {"/compare.html", kHtml, {}},
                                        {"/scan.html", kHtml, {}},
                                        {"/docs.html", kHtml, {}},
                                        {"/docs.js", "text/javascript", kPlain, kPacked}};

  TemporaryFolder folder_;
  Installation installation_ = open_installation({.folder = folder_.path()}).value();
  Log log_ = Log::open("").value();
  Uploads uploads_{folder_.path() / "uploads", {.bytes = 1 << 20, .per_token = 3}};
  Quota quota_{*installation_.catalogue, uploads_, 3 << 20};
  PublishJobs publishing_{{*installation_.store, *installation_.catalogue, uploads_, quota_,
                           folder_.path(), VITRINE_BIN_DIR "/vitrined"}};
  ScanService scans_;
  PublishedModels models_{*installation_.store, *installation_.catalogue};
  ExportCache exports_{0};
  WebPages pages_{kPages};
  LiveSettings settings_{Settings{}};
  Metrics metrics_;
  VisitCounter visits_{*installation_.visits};
  Authenticator tokens_{*installation_.tokens};
  Log events_ = Log::open(folder_.path() / "events.log").value();
  Collector collector_{{*installation_.store, *installation_.catalogue, *installation_.jobs,
                        uploads_, events_, std::chrono::seconds(0)}};
  Scrubber scrubber_{{.store = *installation_.store,
                      .catalogue = *installation_.catalogue,
                      .models = models_,
                      .catalogue_faults = [] { return NoFaults(); },
                      .events = events_}};
  Webhooks webhooks_{{"127.0.0.1"}, events_};
  Services services_{.store = *installation_.store,
                     .catalogue = *installation_.catalogue,
                     .tokens = tokens_,
                     .models = models_,
                     .scans = scans_,
                     .uploads = uploads_,
                     .quota = quota_,
                     .collector = collector_,
                     .scrubber = scrubber_,
                     .webhooks = webhooks_,
                     .exports = exports_,
                     .pages = pages_,
                     .settings = settings_,
                     .metrics = metrics_,
                     .visits = visits_,
                     .notes = *installation_.notes,
                     .log = log_,
                     .errors = events_,
                     .is_ready = true};
  asio::io_context io_;
  Workers workers_;
  HttpServer server_;
  std::uint16_t port_;
  std::thread thread_;
};

}  // namespace vitrine::test
