// SPDX-License-Identifier: Apache-2.0
#include "acquisition/rig/run.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "acquisition/rig/operator_socket.h"
#include "acquisition/rig/options.h"
#include "acquisition/rig/private_network.h"
#include "acquisition/rig/rig_file.h"
#include "acquisition/rig/rig_scanner.h"
#include "acquisition/rig/run_command.h"
#include "acquisition/rig/truth.h"
#include "acquisition/rig_optics/plate.h"
#include "acquisition/rig_optics/solid.h"
#include "codec/files/atomic_file.h"

namespace vitrine::acquisition::rig {
namespace {

namespace fs = std::filesystem;

// A temporary folder for the operator's socket. The destructor removes it.
class OwnFolder {
 public:
  OwnFolder() {
    std::error_code none;
    path_ = (fs::temp_directory_path(none) / "vitrine-rig-XXXXXX").string();
    if (::mkdtemp(path_.data()) == nullptr) path_.clear();
  }
  ~OwnFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  fs::path socket() const { return fs::path(path_) / "rig.sock"; }

 private:
  std::string path_;
};

Expected<void> write_text(const std::string& path, std::string_view text) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(text.data());
  return write_file_atomically(path, {first, text.size()});
}

BoardAddress address_of(const RigOptions& options) {
  const bool fabscan = options.dialect == "fabscan";
  const UsbBoardSettings board = board_settings(options.realism.seed, fabscan);
  const UsbIds ids = ids_of(board.transport);
  return {options.dialect, fmt::format("{:#06x}", ids.vendor), fmt::format("{:#06x}", ids.product),
          board.serial};
}

Expected<void> write_config(const RigOptions& options, const fs::path& socket) {
  if (options.write_config.empty()) return {};
  const fs::path folder = fs::absolute(folder_of(options.write_config)).lexically_normal();
  return write_text(options.write_config, to_json({.name = options.name,
                                                   .camera_address = options.address,
                                                   .board = address_of(options),
                                                   .steps = options.steps,
                                                   .calibrations = folder / "calibrations",
                                                   .socket = socket}));
}

Expected<int> serve(const RigOptions& options, const Subject* object) {
  const OwnFolder folder;
  auto scanner = RigScanner::start({.object = object,
                                    .realism = options.realism,
                                    .faults = options.faults,
                                    .camera_address = options.address,
                                    .is_fabscan = options.dialect == "fabscan",
                                    .degrees_per_second = options.degrees_per_second,
                                    .table = options.table,
                                    .commands = options.write_commands});
  if (!scanner) return tl::unexpected(scanner.error());
  auto listener = open_operator_socket(folder.socket(), (*scanner)->stage());
  if (!listener) return tl::unexpected(listener.error());
  const auto written = write_config(options, folder.socket());
  if (!written) return tl::unexpected(written.error());
  return run_command(options.command);
}

Expected<int> run_with_object(const RigOptions& options) {
  const auto mesh = load(*options.object);
  if (!mesh) return tl::unexpected(mesh.error());
  const Solid solid(*mesh, options.finish);
  if (!options.write_truth.empty()) {
    const auto seen = seen_vertices(*mesh, solid, optics_of(options.realism.seed));
    const auto written = write_file_atomically(options.write_truth, truth_ply(*mesh, seen));
    if (!written) return tl::unexpected(written.error());
  }
  return options.command.empty() ? 0 : serve(options, &solid);
}

Expected<int> run_empty(const RigOptions& options) {
  const Solid bare(plate(), {.is_painted = false, .gloss = 0});
  return serve(options, &bare);
}

int complain(const Error& error, int exit_code) {
  fmt::print(stderr, "vitrine-rig: {}\n", error.message);
  return exit_code;
}

}  // namespace

int run(std::span<const std::string_view> words) {
  const auto options = parse_options(words);
  if (!options) return complain(options.error(), 2);
  if (options->shows_help) return fmt::print("{}\n", usage()), 0;
  if (options->shows_version) return fmt::print("vitrine-rig " VITRINE_VERSION "\n"), 0;
  if (options->has_private_network) {
    const auto entered = enter_private_network();
    if (!entered) return complain(entered.error(), 1);
  }
  hold_signals();
  const auto code = options->object ? run_with_object(*options) : run_empty(*options);
  return code ? *code : complain(code.error(), 1);
}

}  // namespace vitrine::acquisition::rig
