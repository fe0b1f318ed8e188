// SPDX-License-Identifier: Apache-2.0
// Divides a loop among threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

namespace vitrine::inline codec {

// Calls work(i) once for each i in [0, count), on at most `threads` (>= 1) threads, one of which is
// the caller's. Calls start in ascending order of i. Returns after all calls have ended. If calls
// throw, rethrows one of the exceptions after all threads have stopped.
//
// The result is the same for any number of threads if no call reads data that another call writes.
template <class Work>
void for_each_index(unsigned threads, std::size_t count, const Work& work) {
  if (threads == 1 || count == 1) {  // a single thread needs no atomic counter
    for (std::size_t i = 0; i < count; ++i)
      work(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++)
      work(i);
  };
  std::vector<std::future<void>> others;
  for (std::size_t t = 1; t < std::min<std::size_t>(threads, count); ++t)
    others.push_back(std::async(std::launch::async, run));
  run();
  for (std::future<void>& other : others)
    other.get();
}

}  // namespace vitrine::inline codec
