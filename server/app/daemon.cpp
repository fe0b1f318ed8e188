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

#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/routes.h"
#include "server/api/services.h"
#include "server/app/check_settings.h"
#include "server/app/host_system.h"
#include "server/app/poster_queue.h"
#include "server/config/command_line.h"
#include "server/config/host_names.h"
#include "server/config/live_settings.h"
#include "server/config/read_file.h"
#include "server/config/reload.h"
#include "server/http/http_server.h"
#include "server/jobs/cache_purge.h"
#include "server/jobs/clock.h"
#include "server/jobs/open_scanners.h"
#include "server/jobs/periodic_task.h"
#include "server/jobs/place_of.h"
#include "server/jobs/publish_jobs.h"
#include "server/metadata/text.h"
#include "server/remote/remote_server.h"
#include "server/store/daemon_lock.h"
#include "server/store/installation.h"
#include "server/store/new_public_files.h"
#include "server/transport/live_tls.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kAdminConnections = 64;
constexpr std::chrono::minutes kCollectEvery{10};
constexpr std::chrono::milliseconds kStaleness{100};  // how long cached models may be out of date
// How often cached models are checked, even without requests.
constexpr std::chrono::milliseconds kModelCheckEvery{500};
constexpr std::chrono::seconds kScannerLease{30};
// How often counted visits are written. A killed daemon loses the visits since the last write.
constexpr std::chrono::seconds kVisitFlushEvery{10};
// Webhooks that the settings do not allow are dropped this long after their jobs have ended.
constexpr std::chrono::milliseconds kUnwanted = std::chrono::hours(24);

// The current configuration, and a function that reads its file and environment again.
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

// Owns all parts of the daemon. Each member may depend on those declared before it.
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
                live_.get().model_cache_bytes),
        uploads_(uploads_of(live_.get()), {.bytes = live_.get().max_upload_bytes,
                                           .per_token = live_.get().max_uploads,
                                           .lifetime = live_.get().upload_lifetime}),
        quota_(*installation_.catalogue, uploads_, live_.get().quota_bytes),
        webhooks_(live_.get().webhook_hosts, events_, live_.get().webhook_key),
        purge_(live_.get().purge_urls, *installation_.catalogue, events_),
        publishing_({.store = *installation_.store,
                     .catalogue = *installation_.catalogue,
                     .uploads = uploads_,
                     .quota = quota_,
                     .data = live_.get().data,
                     .disk_reserve = [this] { return live_.get().disk_reserve_bytes; }}),
        collector_({*installation_.store, *installation_.catalogue, *installation_.jobs, uploads_,
                    events_, live_.get().collect_after}),
        scrubber_(
            {.store = *installation_.store,
             .catalogue = *installation_.catalogue,
             .models = models_,
             .catalogue_faults = [this] { return find_catalogue_faults(installation_.place); },
             .events = events_,
             .forget = [this](auto chunks) { purge_.forget(std::move(chunks)); }}),
        scans_({.store = *installation_.store,
                .catalogue = *installation_.catalogue,
                .jobs = *installation_.jobs,
                .events = events_,
                .data = live_.get().data,
                .disk_reserve = [this] { return live_.get().disk_reserve_bytes; },
                .publishing = [this](JobRun& run) { return publishing_.work(run); },
                .quota = &quota_,
                .taken = {.builds = live_.get().roles.builds,
                          .scans = live_.get().roles.scans,
                          .holder = lock_.id,
                          .drives =
                              [this](const std::string& scanner) {
                                return claims_->has_jobs_of(scanner);
                              }},
                .claims = claims_.get(),
                .when_added =
                    [this](const ModelId& model) {
                      // Ignores a failure, because check_models() queues the posters of new models,
                      // too.
                      if (live_.get().roles.serves) (void)make_posters(model, services_);
                    }},
               std::move(scanners)),
        exports_(live_.get().export_cache_bytes),
        pages_(web_assets()),
        metrics_(path_templates(public_routes())),
        visits_(*installation_.visits),
        tokens_(*installation_.tokens),
        services_{.store = *installation_.store,
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
                  .settings = live_,
                  .metrics = metrics_,
                  .visits = visits_,
                  .notes = *installation_.notes,
                  .log = access_log_,
                  .errors = events_},
        connections_(connections_within_limit(live_.get().max_connections)),
        threads_(live_.get().threads > 0 ? live_.get().threads
                                         : std::max(1u, std::thread::hardware_concurrency())),
        io_(static_cast<int>(threads_)),
        workers_({.threads = threads_,
                  .waiting_threads = Services::kWaitingThreads,
                  .urgent_threads = Services::kUrgentThreads}),
        public_(io_, http_dependencies(), public_options()),
        admin_(io_, http_dependencies(), admin_options()),
        control_(asio::make_strand(io_)),
        signals_(control_, SIGTERM, SIGINT),
        reload_signals_(control_, SIGHUP, SIGUSR1),
        deadline_(control_),
        watchdog_(control_) {}

  Expected<void> open() {
    if (lock_.is_copy) {
      events_.event(
          Severity::kWarning,
          "the data folder is a copy of another daemon's: this daemon gets a new identity "
          "and waits until the leases of the original expire");
    }
    state_disk_limits();
    if (live_.get().roles.serves) {
      if (auto bound = listen(public_, live_.get().listen, live_.get().port_file, ""); !bound)
        return bound;
    }
    if (auto bound =
            listen(admin_, live_.get().admin_listen, live_.get().admin_port_file, "admin ");
        !bound)
      return bound;
    if (!live_.get().webhook_hosts.empty())
      scans_.jobs().when_ended([this](const JobStatus& job) { tell_of(job); });
    if (!live_.get().purge_urls.empty()) {
      installation_.catalogue->when_hidden(
          [this](std::vector<Sha256> chunks) { purge_.forget_hidden(std::move(chunks)); });
    }
    claims_->start(scans_.names());
    return scans_.start();
  }

  void run() {
    if (connections_ < live_.get().max_connections) {
      events_.event(Severity::kWarning,
                    fmt::format("the limit on open files allows only {} connections; raise it",
                                connections_));
    }
    if (others_may_read(live_.get().data)) {
      events_.event(Severity::kWarning,
                    fmt::format("every user of the machine can read drafts in the data folder; run "
                                "chmod o-rwx {}",
                                live_.get().data.string()));
    }
    models_.limit_copies_to([this] { return room_of(live_.get()); });
    models_.refresh_by(
        [this](auto task) { asio::post(workers_.executor(Executor::kWorker), std::move(task)); });
    wait_for_signal();
    wait_for_reload();
    admin_.start();
    collector_.start(kCollectEvery);
    scrubber_.start(live_.get().scrub_rate);
    services_.order_posters = [this](const ModelId& model) { posters_.add(model); };
    if (live_.get().roles.serves) {
      public_.start();
      model_check_.emplace(kModelCheckEvery, events_, [this] { check_models(); });
      visit_flush_.emplace(kVisitFlushEvery, events_, [this] { flush_visits(); });
    }
    services_.is_ready = true;
    tell_service_manager(ServicePhase::kReady);
    keep_watchdog();
    std::vector<std::thread> threads;
    for (unsigned i = 1; i < threads_; ++i)
      threads.emplace_back([this] { serve_connections(); });
    serve_connections();
    for (std::thread& thread : threads)
      thread.join();
    model_check_.reset();
    scans_.stop();
    collector_.stop();
    scrubber_.stop();
    webhooks_.stop();
    purge_.stop();
    workers_.stop();
    workers_.join();
    visit_flush_.reset();
    flush_visits();
    claims_->stop();
    for (const auto& dropped :
         {installation_.jobs->drop_leases(lock_.id), installation_.jobs->drop_scanners(lock_.id)}) {
      if (!dropped) events_.event(Severity::kError, dropped.error().message);
    }
    events_.event(Severity::kInfo, "stopped");
  }

 private:
  // Serves connections until the daemon stops. An uncaught exception, such as std::bad_alloc, ends
  // one connection, not all.
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

  // Runs at intervals, even without requests. Closes the files of models that visitors no longer
  // see, and queues the posters of newly published models. If the store copies a file to open it,
  // as for S3, queues the posters of open models only.
  void check_models() {
    static_cast<void>(models_.revision());
    for (const ModelId& model : new_files_.find())
      if (!installation_.store->keeps_copies() || models_.cached(model)) posters_.add(model);
  }

  void flush_visits() {
    if (const auto done = visits_.flush(); !done)
      events_.event(Severity::kError, done.error().message);
  }

  void tell_of(const JobStatus& job) {
    constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
    const JobRecord& ended = job.record;
    const auto told = [this, id = ended.id] {
      if (const auto kept = installation_.jobs->set_notified(id); !kept)
        events_.event(Severity::kError, kept.error().message);
    };
    // Drops a webhook that these settings do not allow only when its job ended kUnwanted ago. Until
    // then, another daemon with newer settings may call it.
    const bool is_old = now_in_milliseconds() - ended.ended > kUnwanted.count();
    if (!webhooks_.allows(ended.webhook) && is_old) {
      events_.event(Severity::kWarning,
                    fmt::format("webhook {} is not called: webhook-hosts no longer names it",
                                origin_of(ended.webhook)));
      return told();
    }
    webhooks_.call({.url = ended.webhook,
                    .id = ended.id.to_string(),
                    .json = job_json(job).dump(-1, ' ', false, kReplace),
                    .may = [this, id = ended.id] { return scans_.jobs().may_notify(id); },
                    .done = told});
  }

  HttpDependencies http_dependencies() {
    return {.tokens = tokens_,
            .workers = workers_,
            .metrics = metrics_,
            .access_log = access_log_,
            .events = events_};
  }

  HttpOptions public_options() {
    return {.routes = bind(public_routes(), services_),
            .parameters = parameter_patterns(),
            .answers_to = [this](auto host) { return is_public_host(live_.get(), host); },
            .trusts_origin = [this](auto origin) { return is_trusted_origin(live_.get(), origin); },
            .is_recorded = true,
            .shortens_addresses = live_.get().shortens_addresses,
            .max_connections = connections_,
            .idle_timeout = live_.get().idle_timeout,
            .tls = tls_,
            .max_connections_per_address =
                connections_of(live_.get().max_connections_per_address, connections_),
            .proxies = live_.get().trusted_proxies,
            .request_rate = live_.get().request_rate,
            .min_rate = live_.get().min_rate,
            .answer_memory = live_.get().answer_memory_bytes};
  }

  HttpOptions admin_options() {
    return {.routes = bind(admin_routes(), services_),
            .answers_to = [this](auto host) { return is_own_host(live_.get(), host); },
            .is_read_by_pages = false,
            .is_recorded = false,
            .shortens_addresses = live_.get().shortens_addresses,
            .max_connections = kAdminConnections,
            .idle_timeout = live_.get().idle_timeout};
  }

  Expected<void> listen(HttpServer& server, const Endpoint& endpoint,
                        const std::filesystem::path& port_file, std::string_view what) {
    const auto port = server.listen(endpoint);
    if (!port) return what.empty() ? tl::unexpected(port.error()) : of_admin(port.error());
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
      if (signal == SIGHUP && at_terminal_ &&
          // If standard input is no longer a terminal, the terminal was closed.
          ::isatty(STDIN_FILENO) == 0) {
        signals_.cancel();
        return drain();
      }
      // Waits for the next signal first, since the calls below may throw.
      wait_for_reload();
      signal == SIGHUP ? reload() : report_reopened_log();
    });
  }

  // Reads the configuration again. Takes all steps that can fail before the first change.
  void reload() {
    tell_service_manager(ServicePhase::kReloading);
    if (const auto done = try_reload(); !done) {
      events_.event(Severity::kError, "the configuration stays as it was: " + done.error().message);
      report_reopened_log();
    }
    tell_service_manager(ServicePhase::kReady);
  }

  Expected<void> try_reload() {
    const auto fresh = configuration_.reread();
    if (!fresh) return tl::unexpected(fresh.error());
    auto next = vitrine::server::reload(configuration_.line, *fresh);
    if (!next) return tl::unexpected(next.error());
    if (auto opened = reopen_log(next->line.settings); !opened) return opened;
    configuration_.line = std::move(next->line);
    live_.replace(configuration_.line.settings);
    apply_limits();
    events_.event(Severity::kInfo, "configuration read again; new: " + list_keys(next->changed));
    if (!next->waiting.empty()) {
      events_.event(Severity::kWarning, "restart to apply the new " + list_keys(next->waiting));
    }
    return {};
  }

  void state_disk_limits() {
    const auto stated = write_limits(live_.get().data, disk_limits_of(live_.get()));
    if (!stated) events_.event(Severity::kWarning, stated.error().message);
  }

  void apply_limits() {
    const Settings& now = live_.get();
    state_disk_limits();
    exports_.set_capacity(now.export_cache_bytes);
    models_.set_capacity(now.model_cache_bytes);
    const std::size_t connections = connections_within_limit(now.max_connections);
    public_.set_limits({.max_connections = connections,
                        .per_address = connections_of(now.max_connections_per_address, connections),
                        .idle_timeout = now.idle_timeout,
                        .answer_memory = now.answer_memory_bytes});
    admin_.set_limits({.max_connections = kAdminConnections, .idle_timeout = now.idle_timeout});
  }

  Expected<void> reopen_log(const Settings& settings) {
    return access_log_.reopen(settings.access_log, settings.access_log_bytes);
  }

  void report_reopened_log() {
    const auto opened = reopen_log(live_.get());
    events_.event(opened ? Severity::kInfo : Severity::kError,
                  opened ? "access log reopened" : opened.error().message);
  }

  // Tells the service manager at intervals that the daemon is alive. If the connections' threads or
  // the workers make no progress, these messages stop and the service manager restarts the daemon.
  void keep_watchdog() {
    const auto interval = watchdog_interval();
    if (!interval) return;
    watchdog_.expires_after(*interval);
    watchdog_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      keep_watchdog();
      asio::post(workers_.executor(Executor::kWorker), [] { tell_alive(); });
    });
  }

  void drain() {
    services_.is_ready = false;
    reload_signals_.cancel();  // reload signals are ignored from now on
    tell_service_manager(ServicePhase::kStopping);
    events_.event(Severity::kInfo, "stopping: finishing open transfers");
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) io_.stop();
    });
    deadline_.expires_after(live_.get().stop_timeout);
    deadline_.async_wait([this](const boost::system::error_code& error) {
      if (!error) io_.stop();
    });
    // Stops scans while connections drain, so that laser and motor are switched off soon. Scans
    // resume at the next start.
    asio::post(workers_.executor(Executor::kDevice), [this] { scans_.stop(); });
    public_.drain([this] { io_.stop(); });
  }

  // `configuration_` is used only on the strand `control_` once the daemon waits for signals.
  Configuration configuration_;
  LiveSettings live_;
  const std::shared_ptr<LiveTls> tls_;  // null if the daemon does not use TLS
  const bool at_terminal_ = ::isatty(STDIN_FILENO) == 1;
  const Installation installation_;
  const DataFolderLock lock_;
  Log access_log_;
  const std::unique_ptr<ScannerClaims> claims_;
  const Log events_ = Log::to_stderr();
  PublishedModels models_;
  Uploads uploads_;
  Quota quota_;
  Webhooks webhooks_;
  CachePurge purge_;
  PublishJobs publishing_;
  Collector collector_;
  Scrubber scrubber_;
  ScanService scans_;
  ExportCache exports_;
  NewPublicFiles new_files_{*installation_.catalogue};  // used only by check_models()
  const WebPages pages_;
  Metrics metrics_;
  VisitCounter visits_;
  Authenticator tokens_;
  Services services_;
  const std::uint32_t connections_;
  const unsigned threads_;
  asio::io_context io_;
  Workers workers_;
  PosterQueue posters_{workers_, io_, events_,
                       [this](const ModelId& model) { return make_posters(model, services_); }};
  HttpServer public_;
  HttpServer admin_;
  asio::strand<asio::io_context::executor_type> control_;  // runs the handlers of the members below
  asio::signal_set signals_;
  asio::signal_set reload_signals_;
  asio::steady_timer deadline_;
  asio::steady_timer watchdog_;
  std::optional<PeriodicTask> model_check_, visit_flush_;
};

int report(const Error& error) {
  std::fputs(fmt::format("vitrined: {}\n", as_plain_text(error.message)).c_str(), stderr);
  return error.code == ErrorCode::kBadInput ? kExitUsage : kExitFailed;
}

int print(const std::string& text) {
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return kExitDone;
  return report({ErrorCode::kIo, fmt::format("cannot write to stdout: {}; check where it goes",
                                             std::strerror(errno))});
}

std::span<const std::filesystem::path> scanners_of(const Settings& settings) {
  if (!settings.roles.scans) return {};
  return settings.scanners;
}

int serve(Configuration configuration) {
  const Settings& settings = configuration.line.settings;
  // Checks the settings first, so that a wrong setting is reported even if another program already
  // uses the port.
  auto tls = check_files(settings, scanners_of(settings));
  if (!tls) return report(tls.error());
  if (const auto usable = check_addresses(settings); !usable) return report(usable.error());
  if (const auto made = make_data_folder(settings.data); !made) return report(made.error());
  // Locks the folder before open_installation(), which may migrate the catalogue.
  auto lock = lock_data_folder(settings.data);
  if (!lock) return report(lock.error());
  auto installation = open_installation(place_of(settings));
  if (!installation) return report(installation.error());
  auto access_log = Log::open(settings.access_log, settings.access_log_bytes);
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
  if (const auto valid = check_files(settings, settings.scanners); !valid)
    return report(valid.error());
  return print("the configuration is valid\n");
}

}  // namespace

int run_daemon(std::span<const std::string_view> arguments,
               std::span<const std::string_view> environment) {
  // A write to a connection that the client has closed must not kill the daemon. sendfile(2) has no
  // flag like MSG_NOSIGNAL of send(2), so SIGPIPE is ignored.
  std::signal(SIGPIPE, SIG_IGN);
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

}  // namespace vitrine::server
