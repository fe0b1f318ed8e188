// SPDX-License-Identifier: Apache-2.0
// The sections of the benchmark, one file each.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "../codec/report.h"

namespace vitrine::bench {

struct Options {
  bool is_quick = false;
  std::filesystem::path pictures;  // folder for pictures; empty: no pictures
};

// A mesh file whose y axis points upwards.
struct Object {
  std::string name;
  std::filesystem::path file;
};

// Returns the heads, busts and similar objects in the folder VITRINE_MODELS. Without that variable,
// returns the two in tests/models.
std::vector<Object> objects();
// Returns the object named `name`, or the first object if no object has that name.
const Object& object_of(const std::vector<Object>& all, const std::string& name);

// Reports a measured value that is compared with a fixed limit, not with another program.
inline void judge(Report& report, const std::string& what, const std::string& key, double value,
                  double limit = kNoThreshold) {
  report.add({what, key, 0, 0, value, limit});
}

// Scans with the installed programs over GigE Vision and USB. Compares the published, decoded model
// with the object on the table.
void ground_truth(Report& report, const Options& options, const std::vector<Object>& objects);

// Reports the accuracy for one object at different speckle, exposure, numbers of steps, and degrees
// of the calibration's polynomial.
void error_table(Report& report, const Options& options, const Object& object);

// Repeats the experiment of [WLL] table 1. Also compares the accuracy of sampling methods at equal
// numbers of vertices.
void sampling(Report& report, const Options& options, const Object& object);

// Repeats the experiment of [WLL] table 2 with a scanned mesh.
void simplification(Report& report, const Options& options, const Object& skull,
                    const Object& head);

// Measures frames, points and whole scans per second, and the delay of an emergency stop.
void speed(Report& report, const Options& options, const Object& object);

// Measures the longest time from a REST request for an emergency stop until the daemon has switched
// off laser and motor.
void emergency_stop(Report& report, const Object& object);

// Sends the requests of emergency_stop() to the daemon of `folder`, and prints for each the
// milliseconds until laser and motor were off.
int run_emergency_stops(const std::filesystem::path& folder);

// Measures the baseline of speed(): turns the table and takes as many pictures as a scan of `steps`
// steps, without processing them. Prints the time in seconds.
int run_bare_camera(const std::filesystem::path& config, int steps);

}  // namespace vitrine::bench
