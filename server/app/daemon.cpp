// SPDX-License-Identifier: Apache-2.0
#include "server/app/daemon.h"

#include <fmt/format.h>
#include <unistd.h>

#include <boost/asio/signal_set.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/app/check_paths.h"
#include "server/app/daemon_lock.h"
#include "server/app/descriptor_limit.h"
#include "server/app/port_file.h"
#include "server/app/service_manager.h"
#include "server/app/streams.h"
#include "server/config/command_line.h"
#include "server/config/live_settings.h"
#include "server/config/read_file.h"
#include "server/config/reload.h"
#include "server/http/http_server.h"
#include "server/http/job_json.h"
#include "server/http/routes.h"
#include "server/http/services.h"
#include "server/jobs/clock.h"
#include "server/jobs/open_scanners.h"
#include "server/jobs/place_of.h"
#include "server/jobs/publish_jobs.h"
#include "server/remote/remote_server.h"
#include "server/store/installation.h"
#include "server/transport/live_tls.h"

namespace vitrine {
namespace {

constexpr std::size_t kAdminConnections = 64;
constexpr std::chrono::minutes kCollectEvery{10};
constexpr std::chrono::milliseconds kStaleness{100};  // of what is known of models
constexpr std::chrono::seconds kScannerLease{30};
constexpr std::chrono::milliseconds kUnwanted = std::chrono::hours(24);  // who may be told later
constexpr std::size_t kMaxExports = 64;  // each holds a decoded mesh while it runs

Unexpected of_admin(const Error& error) {
  return fail(error.code, "--admin-listen: " + error.message);
}

// Asked before the data folder is made, so that a start that fails leaves nothing.
Expected<void> check_addresses(const Settings& settings) {
  if (settings.roles.serve) {
    if (auto usable = check_address(settings.listen); !usable) return usable;
  }
  const auto usable = check_address(settings.admin_listen);
  return usable ? Expected<void>{} : of_admin(usable.error());
}

// The configuration in force, and how it is read again.
struct Configuration {
  CommandLine line;
  std::function<Expected<CommandLine>()> reread;
};

std::string url_of(const Endpoint& endpoint, std::uint16_t port, bool encrypted) {
  if (!endpoint.path.empty()) return "unix:" + endpoint.path;
  const bool v6 = endpoint.host.find(':') != std::string::npos;
  return fmt::format("{}://{}{}{}:{}", encrypted ? "https" : "http", v6 ? "[" : "", endpoint.host,
                     v6 ? "]" : "", port);
}

// Null where the settings want none.
Expected<std::shared_ptr<LiveTls>> open_tls(const Settings& settings) {
  const TlsFiles files{settings.tls_certificate, settings.tls_key};
  if (files == TlsFiles{}) return nullptr;
  if (files.certificate.empty() || files.key.empty()) {
    return fail(ErrorCode::kBadInput,
                fmt::format("{} is set alone; set {}, too",
                            files.key.empty() ? "tls-certificate" : "tls-key",
                            files.key.empty() ? "tls-key" : "tls-certificate"));
  }
  return LiveTls::open(files);
}

// Everything that serves, in the order in which it may depend on what comes before.
class Daemon {
 public:
  Daemon(Configuration configuration, Installation installation, DataFolderLock lock,
         Log access_log, std::unique_ptr<ScannerClaims> claims,
         std::vector<std::unique_ptr<ScannerBackend>> scanners, std::shared_ptr<LiveTls> tls)
      : configuration_(std::move(configuration)),
        live_(configuration_.line.settings),
        tls_(std::move(tls)),
        installation_(std::move(installation)),
        lock_(std::move(lock)),
        access_log_(std::move(access_log)),
        claims_(std::move(claims)),
        models_(*installation_.store, *installation_.catalogue, kStaleness,
                live_.get()->model_cache_bytes),
        uploads_(uploads_of(*live_.get()), {.bytes = live_.get()->max_upload_bytes,
                                            .per_token = live_.get()->max_uploads,
                                            .lifetime = live_.get()->upload_lifetime}),
        quota_(*installation_.catalogue, uploads_, live_.get()->quota_bytes),
        webhooks_(live_.get()->webhook_hosts, events_),
        publishing_(
            {*installation_.store, *installation_.catalogue, uploads_, quota_, live_.get()->data}),
        collector_({*installation_.store, *installation_.catalogue, *installation_.jobs, uploads_,
                    events_, live_.get()->collect_after}),
        scans_({*installation_.store,
                *installation_.catalogue,
                *installation_.jobs,
                events_,
                live_.get()->data,
                "/proc/self/exe",
                std::chrono::seconds(10),
                [this](JobRun& run) { return publishing_.work(run); },
                &quota_,
                {live_.get()->roles.build, live_.get()->roles.scan, lock_.id,
                 [this](const std::string& scanner) { return claims_->has_jobs_of(scanner); }},
                claims_.get()},
               std::move(scanners)),
        exports_(live_.get()->export_cache_bytes),
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
                  live_,
                  metrics_,
                  access_log_,
                  events_},
        connections_(connections_within_limit(live_.get()->max_connections)),
        threads_(live_.get()->threads > 0 ? live_.get()->threads
                                          : std::max(1u, std::thread::hardware_concurrency())),
        io_(static_cast<int>(threads_)),
        workers_(threads_, kMaxExports),
        public_(io_, services_, workers_, public_options()),
        admin_(io_, services_, workers_, admin_options()),
        control_(asio::make_strand(io_)),
        signals_(control_, SIGTERM, SIGINT),
        reload_signals_(control_, SIGHUP, SIGUSR1),
        deadline_(control_),
        watchdog_(control_) {}

  Expected<void> open() {
    if (lock_.is_copy) {
      events_.event(Severity::kWarning,
                    "the data folder is a copy: this daemon is another than the one of the "
                    "original, and waits until what that one held is free");
    }
    if (live_.get()->roles.serve) {
      if (const auto kept = write_quota(live_.get()->data, live_.get()->quota_bytes); !kept)
        events_.event(Severity::kWarning, kept.error().message);
      if (auto bound = bind(public_, live_.get()->listen, live_.get()->port_file, ""); !bound)
        return bound;
    }
    if (auto bound =
            bind(admin_, live_.get()->admin_listen, live_.get()->admin_port_file, "admin ");
        !bound)
      return bound;
    if (!live_.get()->webhook_hosts.empty())
      scans_.jobs().when_ended([this](const JobStatus& job) { tell_of(job); });
    claims_->start(scans_.names());
    return scans_.start();
  }

  void run() {
    if (connections_ < live_.get()->max_connections) {
      events_.event(
          Severity::kWarning,
          fmt::format("only {} connections fit the limit on open files; raise it", connections_));
    }
    models_.refresh_by([this](std::function<void()> refresh) {
      asio::post(workers_.executor(Place::kWorker, ""), std::move(refresh));
    });
    wait_for_signal();
    wait_for_reload();
    if (live_.get()->roles.serve) public_.start();
    admin_.start();
    collector_.start(kCollectEvery);
    services_.ready = true;
    tell_service_manager(ServicePhase::kReady);
    keep_watchdog();
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < threads_; ++i)
      threads.emplace_back([this] { serve_connections(); });
    serve_connections();
    for (std::thread& thread : threads)
      thread.join();
    scans_.stop();
    collector_.stop();
    webhooks_.stop();
    workers_.stop();
    workers_.join();
    claims_->stop();
    for (const auto& dropped :
         {installation_.jobs->drop_leases(lock_.id), installation_.jobs->drop_scanners(lock_.id)}) {
      if (!dropped) events_.event(Severity::kError, dropped.error().message);
    }
    events_.event(Severity::kInfo, "stopped");
  }

 private:
  // What is thrown where nobody catches it (memory has run out) costs one visitor, not all.
  void serve_connections() {
    for (;;) {
      try {
        io_.run();
        return;
      } catch (const std::exception& fault) {
        events_.event(Severity::kError, fault.what());
      }
    }
  }

  void tell_of(const JobStatus& job) {
    constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
    const JobRecord& ended = job.record;
    const auto told = [this, id = ended.id] {
      if (const auto kept = installation_.jobs->set_told(id); !kept)
        events_.event(Severity::kError, kept.error().message);
    };
    // Another daemon may have newer settings, for a while.
    const bool is_old = now_in_milliseconds() - ended.ended > kUnwanted.count();
    if (!webhooks_.allows(ended.webhook) && is_old) {
      events_.event(Severity::kWarning,
                    fmt::format("webhook {} is not told: webhook-hosts has it no more",
                                origin_of(ended.webhook)));
      return told();
    }
    webhooks_.tell(
        ended.webhook, job_json(job).dump(-1, ' ', false, kReplace),
        [this, id = ended.id] { return scans_.jobs().may_tell(id); }, told);
  }

  StreamHost stream_host() { return {services_, workers_, public_.rate_limit(), crowd_}; }

  HttpOptions public_options() {
    return {.routes = public_routes(),
            .recorded = true,
            .max_connections = connections_,
            .patience = live_.get()->idle_timeout,
            .stream = [this](StreamCall call) { return stream(std::move(call), stream_host()); },
            .tls = tls_,
            .max_connections_per_address = live_.get()->max_connections_per_address > 0
                                               ? live_.get()->max_connections_per_address
                                               : SIZE_MAX,
            .proxies = live_.get()->trusted_proxies,
            .request_rate = live_.get()->request_rate,
            .min_rate = live_.get()->min_rate,
            .answer_memory = live_.get()->answer_memory_bytes};
  }

  HttpOptions admin_options() {
    return {.routes = admin_routes(),
            .recorded = false,
            .max_connections = kAdminConnections,
            .patience = live_.get()->idle_timeout,
            .stream = {}};
  }

  Expected<void> bind(HttpServer& server, const Endpoint& endpoint,
                      const std::filesystem::path& port_file, std::string_view what) {
    const auto port = server.listen(endpoint);
    if (!port) return what.empty() ? Unexpected(port.error()) : of_admin(port.error());
    if (auto written = write_port_file(port_file, *port); !written) return written;
    events_.event(Severity::kInfo, fmt::format("{}listening on {}", what,
                                               url_of(endpoint, *port, what.empty() && tls_)));
    return {};
  }

  void wait_for_signal() {
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) drain();
    });
  }

  void wait_for_reload() {
    reload_signals_.async_wait([this](const boost::system::error_code& error, int signal) {
      if (error) return;
      if (signal == SIGHUP && at_terminal_ && ::isatty(STDIN_FILENO) == 0) {  // it was closed
        signals_.cancel();
        return drain();
      }
      wait_for_reload();  // first, as what follows may throw
      signal == SIGHUP ? reload() : reopen_log(live_.get()->access_log);
    });
  }

  // Reads the configuration again. What can fail comes first: a fault leaves all as it was.
  void reload() {
    tell_service_manager(ServicePhase::kReloading);
    if (const auto done = try_reload(); !done) {
      events_.event(Severity::kError, "the configuration stays as it was: " + done.error().message);
      reopen_log(live_.get()->access_log);
    }
    tell_service_manager(ServicePhase::kReady);
  }

  Expected<void> try_reload() {
    const auto fresh = configuration_.reread();
    if (!fresh) return Unexpected(fresh.error());
    auto next = vitrine::reload(configuration_.line, *fresh);
    if (!next) return Unexpected(next.error());
    if (auto opened = access_log_.reopen(next->line.settings.access_log); !opened) return opened;
    configuration_.line = std::move(next->line);
    live_.replace(configuration_.line.settings);
    apply_limits();
    events_.event(Severity::kInfo, "configuration read again; new: " + list_keys(next->changed));
    if (!next->waiting.empty()) {
      events_.event(Severity::kWarning, "restart to have the new " + list_keys(next->waiting));
    }
    return {};
  }

  void apply_limits() {
    const auto now = live_.get();
    exports_.set_capacity(now->export_cache_bytes);
    models_.set_capacity(now->model_cache_bytes);
    public_.set_limits(connections_within_limit(now->max_connections), now->idle_timeout,
                       now->answer_memory_bytes);
    admin_.set_limits(kAdminConnections, now->idle_timeout, UINT64_MAX);
  }

  void reopen_log(const std::filesystem::path& file) {
    const auto opened = access_log_.reopen(file);
    events_.event(opened ? Severity::kInfo : Severity::kError,
                  opened ? "access log opened anew" : opened.error().message);
  }

  // Connections and workers both have to get on, or the service manager starts the daemon anew.
  void keep_watchdog() {
    const auto interval = watchdog_interval();
    if (!interval) return;
    watchdog_.expires_after(*interval);
    watchdog_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      keep_watchdog();
      asio::post(workers_.executor(Place::kWorker, ""), [] { tell_alive(); });
    });
  }

  void drain() {
    services_.ready = false;
    reload_signals_.cancel();  // which are of no use any more, and are not heeded
    tell_service_manager(ServicePhase::kStopping);
    events_.event(Severity::kInfo, "stopping: finishing what is under way");
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) io_.stop();
    });
    deadline_.expires_after(live_.get()->stop_timeout);
    deadline_.async_wait([this](const boost::system::error_code& error) {
      if (!error) io_.stop();
    });
    // Meanwhile, so that laser and motor are off soon: what scans goes on at the next start.
    asio::post(workers_.executor(Place::kDevice, ""), [this] { scans_.stop(); });
    public_.drain([this] { io_.stop(); });
  }

  Configuration configuration_;  // of control_, once signals are awaited
  LiveSettings live_;
  const std::shared_ptr<LiveTls> tls_;  // null: without TLS
  const bool at_terminal_ = ::isatty(STDIN_FILENO) == 1;
  const Installation installation_;
  const DataFolderLock lock_;  // of the data folder
  Log access_log_;
  const std::unique_ptr<ScannerClaims> claims_;
  const Log events_ = Log::to_stderr();
  PublishedModels models_;
  Uploads uploads_;
  Quota quota_;
  Webhooks webhooks_;
  PublishJobs publishing_;
  Collector collector_;
  ScanService scans_;
  ExportCache exports_;
  const WebPages pages_;
  Metrics metrics_;
  Crowd crowd_;
  Authenticator tokens_;
  Services services_;
  const std::uint32_t connections_;
  const unsigned threads_;
  asio::io_context io_;
  Workers workers_;
  HttpServer public_;
  HttpServer admin_;
  asio::strand<asio::io_context::executor_type> control_;  // of what follows
  asio::signal_set signals_;
  asio::signal_set reload_signals_;
  asio::steady_timer deadline_;
  asio::steady_timer watchdog_;
};

int report(const Error& error) {
  std::fputs(fmt::format("vitrined: {}\n", error.message).c_str(), stderr);
  return error.code == ErrorCode::kBadInput ? kExitUsage : kExitFailed;
}

int print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kExitDone;
  return report({ErrorCode::kIo, fmt::format("cannot write to stdout: {}; check where it goes",
                                             std::strerror(errno))});
}

std::span<const std::filesystem::path> scanners_of(const Settings& settings) {
  if (!settings.roles.scan) return {};
  return settings.scanners;
}

int serve(Configuration configuration) {
  const Settings& settings = configuration.line.settings;
  if (const auto usable = check_addresses(settings); !usable) return report(usable.error());
  auto tls = open_tls(settings);
  if (!tls) return report(tls.error());
  if (const auto made = make_data_folder(settings.data); !made) return report(made.error());
  auto lock = lock_data_folder(settings.data);  // before another daemon's catalogue is migrated
  if (!lock) return report(lock.error());
  auto installation = open_installation(place_of(settings));
  if (!installation) return report(installation.error());
  auto access_log = Log::open(settings.access_log);
  if (!access_log) return report(access_log.error());
  auto claims = std::make_unique<ScannerClaims>(
      *installation->jobs, Log::to_stderr(), Lease{lock->id, kScannerLease}, settings.scan_address);
  auto scanners = open_scanners(
      scanners_of(settings),
      [which = claims.get()](const std::string& scanner) { return which->check(scanner); });
  if (!scanners) return report(scanners.error());
  Daemon daemon(std::move(configuration), std::move(*installation), std::move(*lock),
                std::move(*access_log), std::move(claims), std::move(*scanners), std::move(*tls));
  if (const auto opened = daemon.open(); !opened) return report(opened.error());
  daemon.run();
  return kExitDone;
}

int check(const Settings& settings) {
  if (const auto usable = check_paths(settings); !usable) return report(usable.error());
  if (const auto tls = open_tls(settings); !tls) return report(tls.error());
  if (const auto scanners = open_scanners(settings.scanners, {}); !scanners)  // uses no device
    return report(scanners.error());
  return print("the configuration is valid\n");
}

}  // namespace

int run_daemon(std::span<const std::string_view> arguments,
               std::span<const std::string_view> environment) {
  std::signal(SIGPIPE, SIG_IGN);  // sendfile(2) has no MSG_NOSIGNAL
  const auto read = [=] { return parse_command_line(arguments, environment, read_config_file); };
  const auto line = read();
  if (!line) return report(line.error());
  switch (line->action) {
    case Action::kServe:
      return serve({*line, read});
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
