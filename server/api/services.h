// SPDX-License-Identifier: Apache-2.0
// Declares the parts of the daemon that handlers use. The daemon owns these parts. They are
// thread-safe and outlive every connection.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/api/web_pages.h"
#include "server/auth/authenticator.h"
#include "server/catalogue/catalogue.h"
#include "server/catalogue/notes.h"
#include "server/catalogue/visit_counter.h"
#include "server/config/live_settings.h"
#include "server/export/export_cache.h"
#include "server/http/admission_limit.h"
#include "server/jobs/collector.h"
#include "server/jobs/scan_service.h"
#include "server/jobs/scrubber.h"
#include "server/jobs/webhooks.h"
#include "server/log/log.h"
#include "server/metrics/metrics.h"
#include "server/store/published_model.h"
#include "server/store/quota.h"
#include "server/store/uploads.h"
#include "server/stream/busy_streams.h"

namespace vitrine::server {

struct Services {
  ObjectStore& store;
  Catalogue& catalogue;
  Authenticator& tokens;
  PublishedModels& models;
  ScanService& scans;
  Uploads& uploads;
  Quota& quota;
  Collector& collector;
  const Scrubber& scrubber;
  const Webhooks& webhooks;
  ExportCache& exports;
  const WebPages& pages;
  const LiveSettings& settings;
  Metrics& metrics;
  VisitCounter& visits;
  NoteCatalogue& notes;
  const Log& log;     // access log
  const Log& errors;  // log of events that operators must know about
  std::atomic<bool> is_ready{false};
  // Starts to make the posters of a model in the background (Workers::compute()), so that no
  // request waits for them. Handlers call it after a change of a model's public file. Empty in
  // processes without workers.
  std::function<void(const ModelId&)> order_posters = {};

  BusyStreams busy_streams = {};

  // Limits on the number of requests that are being forwarded. Each forwarded request occupies a
  // worker thread until the other daemon responds. There are separate limits for requests without a
  // token, requests with a token, and emergency stops. One address may use at most half of the
  // limit for requests without a token. The worker pool has kWaitingThreads additional threads, so
  // that other requests do not wait for another daemon. One token may occupy a quarter of the pool,
  // which is more than the limit, so forwarded requests cannot use up a token's share either. The
  // threads for emergency stops exceed their limit by two, so that forwarded stops cannot occupy
  // all of them.
  static constexpr std::size_t kMostForwarded = 8;  // limit for each of the three kinds of requests
  static constexpr unsigned kWaitingThreads = 4 * kMostForwarded;
  static constexpr unsigned kUrgentThreads = kMostForwarded + 2;
  const std::shared_ptr<AdmissionLimit> forwarded_for_strangers =
      std::make_shared<AdmissionLimit>(kMostForwarded, kMostForwarded / 2);
  const std::shared_ptr<AdmissionLimit> forwarded_for_callers =
      std::make_shared<AdmissionLimit>(kMostForwarded, kMostForwarded);
  const std::shared_ptr<AdmissionLimit> forwarded_stops =
      std::make_shared<AdmissionLimit>(kMostForwarded, kMostForwarded);
};

}  // namespace vitrine::server
