// SPDX-License-Identifier: Apache-2.0
// What the handlers work with. Owned by the application, outlives every connection, thread-safe.
#pragma once

#include <atomic>

#include "server/auth/authenticator.h"
#include "server/catalogue/catalogue.h"
#include "server/config/live_settings.h"
#include "server/http/export_cache.h"
#include "server/http/web_pages.h"
#include "server/jobs/scan_service.h"
#include "server/log/log.h"
#include "server/metrics/metrics.h"
#include "server/store/published_model.h"

namespace vitrine {

struct Services {
  Catalogue& catalogue;
  Authenticator& tokens;
  PublishedModels& models;
  ScanService& scans;
  ExportCache& exports;
  const WebPages& pages;
  const LiveSettings& settings;
  Metrics& metrics;
  const Log& log;     // the access log
  const Log& errors;  // what the operator must know
  std::atomic<bool> ready{false};
};

}  // namespace vitrine
