// SPDX-License-Identifier: Apache-2.0
#include "server/catalogue/visit_counter.h"

#include <utility>

namespace vitrine::server {

void VisitCounter::count(const ModelDay& at, const VisitCounts& more) {
  const std::scoped_lock lock(mutex_);
  counted_[at] += more;
}

Expected<void> VisitCounter::flush() {
  const std::scoped_lock turn(flushing_);
  VisitsOfDays taken;
  {
    const std::scoped_lock lock(mutex_);
    taken = std::exchange(counted_, {});
  }
  if (taken.empty()) return {};
  auto added = catalogue_.add(taken);
  if (added) return added;
  for (const auto& [at, counts] : taken)
    count(at, counts);
  return added;
}

Expected<VisitCatalogue*> VisitCounter::flushed() {
  if (auto done = flush(); !done) return tl::unexpected(done.error());
  return &catalogue_;
}

}  // namespace vitrine::server
