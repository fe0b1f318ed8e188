// SPDX-License-Identifier: Apache-2.0
// What the handlers work with. Owned by the application, outlives every connection, thread-safe.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "server/auth/authenticator.h"
#include "server/catalogue/catalogue.h"
#include "server/config/live_settings.h"
#include "server/http/export_cache.h"
#include "server/http/seats.h"
#include "server/http/web_pages.h"
#include "server/jobs/collector.h"
#include "server/jobs/scan_service.h"
#include "server/jobs/webhooks.h"
#include "server/log/log.h"
#include "server/metrics/metrics.h"
#include "server/store/published_model.h"
#include "server/store/quota.h"
#include "server/store/uploads.h"

namespace vitrine {

struct Services {
  ObjectStore& store;
  Catalogue& catalogue;
  Authenticator& tokens;
  PublishedModels& models;
  ScanService& scans;
  Uploads& uploads;
  Quota& quota;
  Collector& collector;
  const Webhooks& webhooks;
  ExportCache& exports;
  const WebPages& pages;
  const LiveSettings& settings;
  Metrics& metrics;
  const Log& log;     // the access log
  const Log& errors;  // what the operator must know
  std::atomic<bool> ready{false};

  // Who waits for another daemon: strangers, of whom one address may have half of the seats, and
  // callers with a token, and emergency stops, which find one whoever else waits. There are as many
  // threads for them, so that the others are served, and the watchdog is, whatever that daemon
  // does.
  static constexpr std::size_t kMostElsewhere = 8;  // of each
  const std::shared_ptr<Seats> strangers_elsewhere =
      std::make_shared<Seats>(kMostElsewhere, kMostElsewhere / 2);
  const std::shared_ptr<Seats> callers_elsewhere =
      std::make_shared<Seats>(kMostElsewhere, kMostElsewhere);
  const std::shared_ptr<Seats> stops_elsewhere =
      std::make_shared<Seats>(kMostElsewhere, kMostElsewhere);
};

}  // namespace vitrine
