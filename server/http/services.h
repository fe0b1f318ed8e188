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

  // Strangers that wait for another daemon: no more than there are threads for them, of whom one
  // address may have half.
  static constexpr std::size_t kMostElsewhere = 8;
  const std::shared_ptr<Seats> elsewhere =
      std::make_shared<Seats>(kMostElsewhere, kMostElsewhere / 2);
};

}  // namespace vitrine
