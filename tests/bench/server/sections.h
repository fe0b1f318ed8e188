// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one source file each.
#pragma once

#include "../codec/report.h"

namespace vitrine::bench {

struct Effort {
  bool is_quick = false;  // fewer and shorter runs with less precise results
};

// Compares the daemon with nginx over 64 persistent connections: chunks of 16 KB, and manifests
// answered with 304.
void throughput(Report& report, const Effort& effort);

// Connects 10,000 viewers by WebSocket. Measures the memory of idle viewers, the memory of viewers
// that read nothing, and the fairness among viewers that refine.
void scale(Report& report, const Effort& effort);

// Measures the time until a distant viewer can show the first picture, over HTTP and over
// WebSocket. Needs root.
void first_triangle(Report& report, const Effort& effort);

// Runs visitors, uploads and bad requests for ten minutes (quick: one), and measures the growth of
// memory.
void soak(Report& report, const Effort& effort);

// Measures how streams adapt: to links of 100, 400 and 800 kB/s, to a link that becomes slow, and
// to a camera that turns. Needs root, for network namespaces.
void adaptation(Report& report, const Effort& effort);

// Opens 10,000 connections (quick: 1,000) that send only half of a request's header. Measures the
// memory of each, and the time until the last one is closed.
void half_open(Report& report, const Effort& effort);

// Compares three replicas behind nginx, on one bucket and one database, with one replica behind the
// same nginx: requests per second, and memory per viewer.
void replicas(Report& report, const Effort& effort);

}  // namespace vitrine::bench
