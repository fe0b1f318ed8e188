// SPDX-License-Identifier: Apache-2.0
#include "server/app/daemon.h"

#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/signal_set.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/app/check_paths.h"
#include "server/app/descriptor_limit.h"
#include "server/app/port_file.h"
#include "server/config/command_line.h"
#include "server/http/http_server.h"
#include "server/http/job_json.h"
#include "server/http/routes.h"
#include "server/http/services.h"
#include "server/jobs/open_scanners.h"
#include "server/jobs/publish_jobs.h"
#include "server/store/installation.h"
#include "server/stream/websocket.h"

namespace vitrine {
namespace {

constexpr std::size_t kAdminConnections = 64;
constexpr std::chrono::minutes kCollectEvery{10};
constexpr std::size_t kMaxExports = 64;  // each holds a decoded mesh while it runs

Unexpected of_admin(const Error& error) {
  return fail(error.code, "--admin-listen: " + error.message);
}

// Asked before the data folder is made, so that a start that fails leaves nothing.
Expected<void> check_addresses(const Settings& settings) {
  if (auto usable = check_address(settings.listen); !usable) return usable;
  const auto usable = check_address(settings.admin_listen);
  return usable ? Expected<void>{} : of_admin(usable.error());
}

// Everything that serves, in the order in which it may depend on what comes before.
class Daemon {
 public:
  Daemon(const Settings& settings, Installation installation, Log access_log,
         std::vector<std::unique_ptr<ScannerBackend>> scanners)
      : settings_(settings),
        installation_(std::move(installation)),
        access_log_(std::move(access_log)),
        models_(*installation_.store, *installation_.catalogue),
        uploads_(settings.data / "uploads", {.bytes = settings.max_upload_bytes,
                                             .per_token = settings.max_uploads,
                                             .lifetime = settings.upload_lifetime}),
        quota_(*installation_.catalogue, uploads_, settings.quota_bytes),
        webhooks_(settings.webhook_hosts, events_),
        publishing_(
            {*installation_.store, *installation_.catalogue, uploads_, quota_, settings.data}),
        collector_({*installation_.store, *installation_.catalogue, *installation_.jobs, uploads_,
                    events_, settings.collect_after}),
        scans_({*installation_.store, *installation_.catalogue, *installation_.jobs, events_,
                settings.data, "/proc/self/exe", std::chrono::seconds(10),
                [this](JobRun& run) { return publishing_.work(run); }},
               std::move(scanners)),
        exports_(settings.export_cache_bytes),
        pages_(web_assets()),
        metrics_(Router(public_routes()).templates()),
        tokens_(*installation_.catalogue),
        services_{*installation_.store,
                  *installation_.catalogue,
                  tokens_,
                  models_,
                  scans_,
                  uploads_,
                  quota_,
                  collector_,
                  webhooks_,
                  exports_,
                  pages_,
                  metrics_,
                  access_log_,
                  events_},
        connections_(connections_within_limit(settings.max_connections)),
        threads_(settings.threads > 0 ? settings.threads
                                      : std::max(1u, std::thread::hardware_concurrency())),
        io_(static_cast<int>(threads_)),
        workers_(threads_, kMaxExports),
        public_(io_, services_, workers_, public_options()),
        admin_(io_, services_, workers_, admin_options()),
        signals_(io_, SIGTERM, SIGINT),
        deadline_(io_) {}

  Expected<void> open() {
    if (auto bound = bind(public_, settings_.listen, settings_.port_file, ""); !bound) return bound;
    if (auto bound = bind(admin_, settings_.admin_listen, settings_.admin_port_file, "admin ");
        !bound)
      return bound;
    scans_.jobs().when_ended([this](const JobStatus& job) {
      constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
      webhooks_.tell(job.record.webhook, job_json(job).dump(-1, ' ', false, kReplace));
    });
    return scans_.start();
  }

  void run() {
    if (connections_ < settings_.max_connections) {
      events_.event(
          Severity::kWarning,
          fmt::format("only {} connections fit the limit on open files; raise it", connections_));
    }
    wait_for_signal();
    public_.start();
    admin_.start();
    collector_.start(kCollectEvery);
    services_.ready = true;
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < threads_; ++i)
      threads.emplace_back([this] { io_.run(); });
    io_.run();
    for (std::thread& thread : threads)
      thread.join();
    scans_.stop();
    collector_.stop();
    webhooks_.stop();
    workers_.stop();
    workers_.join();
    events_.event(Severity::kInfo, "stopped");
  }

 private:
  HttpOptions public_options() {
    return {.routes = public_routes(),
            .recorded = true,
            .max_connections = connections_,
            .patience = settings_.idle_timeout,
            .stream = [this](StreamCall call) { return stream(std::move(call)); }};
  }

  HttpOptions admin_options() {
    return {.routes = admin_routes(),
            .recorded = false,
            .max_connections = kAdminConnections,
            .patience = settings_.idle_timeout,
            .stream = {}};
  }

  Expected<void> bind(HttpServer& server, const Endpoint& endpoint,
                      const std::filesystem::path& port_file, std::string_view what) {
    const auto port = server.listen(endpoint);
    if (!port) return what.empty() ? Unexpected(port.error()) : of_admin(port.error());
    if (auto written = write_port_file(port_file, *port); !written) return written;
    const bool v6 = endpoint.host.find(':') != std::string::npos;
    events_.event(Severity::kInfo, fmt::format("{}listening on http://{}{}{}:{}", what,
                                               v6 ? "[" : "", endpoint.host, v6 ? "]" : "", *port));
    return {};
  }

  asio::awaitable<void> stream(StreamCall call) {
    const auto model = models_.find(call.model);
    if (!model || !*model) co_return;  // it was there when the request was answered
    const std::shared_ptr<Connection> connection = call.connection;
    StreamOptions options;
    options.patience = settings_.idle_timeout;
    options.on_drain = [connection](std::function<void()> stop) {
      if (connection->draining) stop();
      connection->on_drain = std::move(stop);
    };
    options.sent = [this](std::uint64_t bytes) {
      metrics_.stream_bytes.fetch_add(bytes, std::memory_order_relaxed);
    };
    metrics_.streams.fetch_add(1, std::memory_order_relaxed);
    co_await serve_stream(connection->socket, std::move(call.request), *model, std::move(options));
    metrics_.streams.fetch_sub(1, std::memory_order_relaxed);
    connection->on_drain = nullptr;
  }

  void wait_for_signal() {
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) drain();
    });
  }

  void drain() {
    services_.ready = false;
    events_.event(Severity::kInfo, "stopping: finishing what is under way");
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) io_.stop();
    });
    deadline_.expires_after(settings_.stop_timeout);
    deadline_.async_wait([this](const boost::system::error_code& error) {
      if (!error) io_.stop();
    });
    // Meanwhile, so that laser and motor are off soon: what scans goes on at the next start.
    asio::post(workers_.executor(Place::kDevice, ""), [this] { scans_.stop(); });
    public_.drain([this] { io_.stop(); });
  }

  const Settings settings_;
  const Installation installation_;
  const Log access_log_;
  const Log events_ = Log::to_stderr();
  PublishedModels models_;
  Uploads uploads_;
  const Quota quota_;
  Webhooks webhooks_;
  PublishJobs publishing_;
  Collector collector_;
  ScanService scans_;
  ExportCache exports_;
  const WebPages pages_;
  Metrics metrics_;
  Authenticator tokens_;
  Services services_;
  const std::uint32_t connections_;
  const unsigned threads_;
  asio::io_context io_;
  Workers workers_;
  HttpServer public_;
  HttpServer admin_;
  asio::signal_set signals_;
  asio::steady_timer deadline_;
};

Expected<std::string> read_file(const std::string& path) {
  std::ifstream file(path);
  int error = errno;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) error = EISDIR;  // opens, and reads as empty
  if (!file || error == EISDIR) {
    return fail(ErrorCode::kIo,
                fmt::format("cannot read {}: {}; check --config", path, std::strerror(error)));
  }
  return std::string(std::istreambuf_iterator<char>(file), {});
}

int report(const Error& error) {
  std::fputs(fmt::format("vitrined: {}\n", error.message).c_str(), stderr);
  return error.code == ErrorCode::kBadInput ? kExitUsage : kExitFailed;
}

int print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kExitDone;
  return report({ErrorCode::kIo, fmt::format("cannot write to stdout: {}; check where it goes",
                                             std::strerror(errno))});
}

int serve(const Settings& settings) {
  if (const auto usable = check_addresses(settings); !usable) return report(usable.error());
  auto installation = open_installation(settings.data);
  if (!installation) return report({ErrorCode::kIo, installation.error().message});
  auto access_log = Log::open(settings.access_log);
  if (!access_log) return report(access_log.error());
  auto scanners = open_scanners(settings.scanners);
  if (!scanners) return report(scanners.error());
  Daemon daemon(settings, std::move(*installation), std::move(*access_log), std::move(*scanners));
  if (const auto opened = daemon.open(); !opened) return report(opened.error());
  daemon.run();
  return kExitDone;
}

int check(const Settings& settings) {
  if (const auto usable = check_paths(settings); !usable) return report(usable.error());
  if (const auto scanners = open_scanners(settings.scanners); !scanners)  // uses no device yet
    return report(scanners.error());
  return print("the configuration is valid\n");
}

}  // namespace

int run_daemon(std::span<const std::string_view> arguments,
               std::span<const std::string_view> environment) {
  std::signal(SIGPIPE, SIG_IGN);  // sendfile(2) has no MSG_NOSIGNAL
  const auto line = parse_command_line(arguments, environment, read_file);
  if (!line) return report(line.error());
  switch (line->action) {
    case Action::kServe:
      return serve(line->settings);
    case Action::kCheckConfig:
      return check(line->settings);
    case Action::kPrintConfig:
      return print(print_config(*line));
    case Action::kHelp:
      return print(reference());
    case Action::kVersion:
      return print("vitrined " VITRINE_VERSION "\n");
  }
  return kExitDone;
}

}  // namespace vitrine
