// SPDX-License-Identifier: Apache-2.0
// What the benchmark compares, one section a file.
#pragma once

#include "../codec/report.h"

namespace vitrine::bench {

struct Effort {
  bool quick = false;  // shorter and fewer runs, for a look
};

// Chunks of 16 KB and manifests answered with 304 over 64 connections that are kept, against nginx.
void throughput(Report& report, const Effort& effort);

// 10,000 viewers on WebSockets: memory of those who look on, fairness among those who refine, and
// those who read nothing.
void scale(Report& report, const Effort& effort);

// The first picture at a viewer that is far away: one request, or one handshake. Needs root.
void first_triangle(Report& report, const Effort& effort);

// Ten minutes (quick: one) of visitors, uploads and bad requests: what memory does meanwhile.
void soak(Report& report, const Effort& effort);

// Streams over links of 100, 400 and 800 kB/s, a link that becomes slow, and a camera that turns.
// Needs root, for network namespaces.
void adaptation(Report& report, const Effort& effort);

// 10,000 connections (quick: 1,000) that send half a header: what each costs, and when the last one
// is cut.
void half_open(Report& report, const Effort& effort);

// Three replicas on one bucket and one database behind nginx against one behind the same nginx:
// requests a second, and memory for each viewer.
void replicas(Report& report, const Effort& effort);

}  // namespace vitrine::bench
