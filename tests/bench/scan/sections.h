// SPDX-License-Identifier: Apache-2.0
// What the benchmark measures, one section a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../codec/report.h"

namespace vitrine::bench {

struct Options {
  bool quick = false;
  std::filesystem::path pictures;  // folder; empty: none
};

// A mesh file that stands upright with its y axis.
struct Object {
  std::string name;
  std::filesystem::path file;
};

// Of heads, busts and the like in the folder VITRINE_MODELS, default the two that ship.
std::vector<Object> objects();
// The one of that name or, where there is none, the first.
const Object& object_of(const std::vector<Object>& all, const std::string& name);

// A figure with a limit of its own instead of a peer.
inline void judge(Report& report, const std::string& what, const std::string& key, double value,
                  double limit = kNoThreshold) {
  report.add({what, key, 0, 0, value, limit});
}

// Scans by the programs themselves, over GigE Vision and USB: the published model, decoded, against
// what stood on the table.
void ground_truth(Report& report, const Options& options, const std::vector<Object>& objects);

// The same figures of one object over speckle, exposure, steps and the polynomial's degree.
void error_table(Report& report, const Options& options, const Object& object);

// The paper's Table 1, and what sampling costs in accuracy at equal numbers of vertices.
void sampling(Report& report, const Options& options, const Object& object);

// The paper's Table 2, of a scanned mesh.
void simplification(Report& report, const Options& options, const Object& skull,
                    const Object& head);

// Frames, points and whole scans a second, and how soon an emergency stop is obeyed.
void speed(Report& report, const Options& options, const Object& object);

// How long a daemon takes to switch laser and motor off after the REST call, at worst.
void emergency_stop(Report& report, const Object& object);

// The calls of emergency_stop(), to the daemon of `folder`; prints the milliseconds of each.
int run_emergency_stops(const std::filesystem::path& folder);

// The bare camera of speed(): turns and takes as many pictures as a scan of `steps`, and does
// nothing with them; prints the seconds.
int run_bare_camera(const std::filesystem::path& config, int steps);

}  // namespace vitrine::bench
