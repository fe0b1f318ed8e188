// SPDX-License-Identifier: Apache-2.0
// The counts of visits to models: one row for each model and day, with sums only. Nothing about a
// single visit or visitor is stored.
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "codec/core/expected.h"
#include "server/catalogue/id.h"

namespace vitrine::server {

// Sums over the visits to a model.
struct VisitCounts {
  std::uint64_t visits = 0;
  std::uint64_t seconds = 0;   // time in which the model was visible
  std::uint64_t levels = 0;    // sum over the visits of the number of the finest level reached
  std::uint64_t complete = 0;  // visits that reached the finest level of the model

  VisitCounts& operator+=(const VisitCounts& more) {
    visits += more.visits;
    seconds += more.seconds;
    levels += more.levels;
    complete += more.complete;
    return *this;
  }
  bool operator==(const VisitCounts&) const = default;
};

struct ModelDay {
  ModelId model;
  std::chrono::sys_days day;  // UTC

  auto operator<=>(const ModelDay&) const = default;
};
using VisitsOfDays = std::map<ModelDay, VisitCounts>;

// Days in UTC, `first` and `last` included.
struct DayRange {
  std::chrono::sys_days first, last;
};

struct ModelVisits {
  ModelId model;
  std::string title;
  VisitCounts counts;
};

struct DayVisits {
  std::chrono::sys_days day;
  ModelVisits of;
};

// Safe to use from several threads at once, and by several processes on the same data. When a model
// is removed from the catalogue, its rows are removed, too. All functions fail with kIo if the
// database fails and with kLimit if the disk is full.
class VisitCatalogue {
 public:
  virtual ~VisitCatalogue() = default;

  // Adds the counts to the stored counts in one transaction. Ignores models that do not exist.
  virtual Expected<void> add(const VisitsOfDays& more) = 0;

  // Returns the sums of each model over the range, the most visited model first. Returns at most
  // `limit` models.
  virtual Expected<std::vector<ModelVisits>> by_model(const DayRange& range,
                                                      std::uint32_t limit) = 0;

  // Returns the counts of each model and day, ordered by day and model. Returns at most `limit`
  // rows.
  virtual Expected<std::vector<DayVisits>> by_day(const DayRange& range, std::uint32_t limit) = 0;
};

}  // namespace vitrine::server
