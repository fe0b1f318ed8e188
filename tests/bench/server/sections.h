// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one source file each.
#pragma once

#include "../codec/report.h"

namespace vitrine::bench {

struct Effort {
  bool is_quick = false;  // shorter and fewer runs, for a quick look
};

// Compares chunks of 16 KB, and manifests answered with 304, with nginx over 64 persistent
// connections.
void throughput(Report& report, const Effort& effort);

// Connects 10,000 viewers with WebSockets. Measures the memory of idle viewers and of viewers that
// read nothing, and the fairness among viewers that refine.
void scale(Report& report, const Effort& effort);

// Measures the time to the first picture of a distant viewer, over HTTP and WebSocket. Needs root.
void first_triangle(Report& report, const Effort& effort);

// Runs visitors, uploads and bad requests for ten minutes (quick: one), and measures the growth of
// memory.
void soak(Report& report, const Effort& effort);

// Measures how streams adapt to links of 100, 400 and 800 kB/s, to a link that becomes slow, and to
// a camera that turns. Needs root, for network namespaces.
void adaptation(Report& report, const Effort& effort);

// Opens 10,000 connections (quick: 1,000) that send half a header. Measures the memory of each, and
// when the last one is closed.
void half_open(Report& report, const Effort& effort);

// Compares three replicas on one bucket and one database behind nginx with one replica behind the
// same nginx: requests per second, and memory per viewer.
void replicas(Report& report, const Effort& effort);

}  // namespace vitrine::bench
