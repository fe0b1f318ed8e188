// SPDX-License-Identifier: Apache-2.0
// Counts visits in memory, and adds the sums to the catalogue from time to time, so that a visit
// costs no write to the database.
#pragma once

#include <mutex>

#include "server/catalogue/visits.h"

namespace vitrine::server {

// Thread-safe. Uses memory in proportion to the number of models, because callers count only visits
// to models that exist.
class VisitCounter {
 public:
  // The catalogue must outlive the counter.
  explicit VisitCounter(VisitCatalogue& catalogue) : catalogue_(catalogue) {}

  void count(const ModelDay& at, const VisitCounts& more);

  // Adds all counts to the catalogue. If this fails, keeps them for the next call and returns the
  // catalogue's error.
  Expected<void> flush();

  // Calls flush() and returns the catalogue, which then includes all visits counted so far. Fails
  // as flush() does.
  Expected<VisitCatalogue*> flushed();

 private:
  VisitCatalogue& catalogue_;
  std::mutex flushing_;  // held by flush(), so that a second call waits for the first
  std::mutex mutex_;     // guards counted_
  VisitsOfDays counted_;
};

}  // namespace vitrine::server
