// SPDX-License-Identifier: Apache-2.0
// A mesh is built, and a .pmesh is verified, in a sandboxed child of a process that has threads:
// the child cannot be a fork of it (sandbox.h), so it is this program once more, started with
// arguments that only it is given.
#pragma once

#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/files/file_descriptor.h"
#include "codec/simplify/simplify.h"
#include "server/jobs/sandbox.h"

namespace vitrine {

struct BuildOrder {
  int bits = 0;  // as in BuildOptions
  Placement placement = Placement::kMidpoint;
  bool z_is_up = false;          // of the mesh; the model has y up
  std::string unit = {};         // as in ReadOptions
  std::filesystem::path folder;  // for what does not fit into memory; empty: nothing may
  std::filesystem::path program = "/proc/self/exe";  // that calls become_build_child()
};

// To be called first of all in main(). Does not return where the arguments are those of a child.
void become_build_child(std::span<const std::string_view> arguments);

class BuildChild {
 public:
  // The .pmesh of the bytes of a mesh file, or nothing where they are a .pmesh that is what it
  // claims to be: then the order does not matter. Errors as run_sandboxed() and build_model() have
  // them, kState where stop() was called.
  Expected<std::vector<std::uint8_t>> build(std::span<const std::uint8_t> mesh,
                                            const BuildOrder& order,
                                            const ProgressReport& progress);
  // The same of an open file, which must stay as it is meanwhile.
  Expected<std::vector<std::uint8_t>> build(const FileDescriptor& mesh, const BuildOrder& order,
                                            const ProgressReport& progress);

  // Ends a build that is under way and any later one. From any thread.
  void stop() noexcept;

 private:
  void watch(int pid);

  std::mutex mutex_;  // guards what follows
  bool stopped_ = false;
  FileDescriptor child_;  // names the process also where its number has been given to another
};

}  // namespace vitrine
