// SPDX-License-Identifier: Apache-2.0
// Builds a model from a mesh, or verifies a .pmesh file, in a sandboxed child of a multi-threaded
// process. Such a process must not fork without exec (sandbox.h). It therefore starts this program
// again, with internal arguments.
#pragma once

#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/files/file_descriptor.h"
#include "codec/simplify/simplify.h"
#include "server/sandbox/sandbox.h"

namespace vitrine::server {

struct BuildOrder {
  int bits = 0;  // bits per coordinate; 0: chosen from the median edge length
  Placement placement = Placement::kMidpoint;
  bool z_is_up = false;   // whether z is up in the mesh; in the model, y is always up
  std::string unit = {};  // unit of the mesh; empty: the unit that its file states
  std::string name = {};  // file name of the mesh, for error messages; may be empty
  // folder of the spill file (spill.h); empty if there must be no spill file
  std::filesystem::path folder;
  std::uint64_t disk_reserve = 0;  // bytes that the spill file leaves free on its disk
  std::filesystem::path program = "/proc/self/exe";  // executable that calls become_build_child()
};

// The value of BuildOrder::disk_reserve if builds may fill the disk.
inline std::uint64_t no_reserve() {
  return 0;
}

// If the arguments are those of a child, runs the child and does not return. Call this first in
// main().
void become_build_child(std::span<const std::string_view> arguments);

struct ChildResult {
  std::vector<std::uint8_t> file;  // the .pmesh file
  // The build's repairs and losses, one line for each kind; at most 4,096 bytes of UTF-8 without
  // control characters. If there are more lines, the last line states their number. The child
  // writes this text, so it may be wrong if the mesh was hostile.
  std::string repairs;
};

class BuildChild {
 public:
  // Builds a model from a mesh file or a package with one. If `mesh` is a .pmesh file, only
  // verifies it, ignores `order` and returns no bytes. Fails with the errors of run_sandboxed() and
  // build_model(), and with kState after stop().
  Expected<ChildResult> build(std::span<const std::uint8_t> mesh, const BuildOrder& order,
                              const ProgressReport& progress);
  // Like the overload above, but reads the mesh from an open file. The file must not change during
  // the call.
  Expected<ChildResult> build(const FileDescriptor& mesh, const BuildOrder& order,
                              const ProgressReport& progress);

  // Stops the running build and makes all later ones fail. May be called from any thread.
  void stop() noexcept;

 private:
  void watch(int pid);

  std::mutex mutex_;  // guards the members below
  bool is_stopped_ = false;
  FileDescriptor child_;  // pidfd of the child, which stays valid if its PID is reused
};

}  // namespace vitrine::server
