// SPDX-License-Identifier: Apache-2.0
// Records which user has changed an installation with which command. Writes to the file audit.log
// of the data folder, in the format of the daemon's audit log.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/log/log.h"

namespace vitrine::server::cli {

class AuditTrail {
 public:
  static constexpr const char* kFile = "audit.log";  // name of the file in the data folder

  // Opens the file in an existing data folder. If the file is missing, creates it for the folder's
  // owner. If this fails with kIo, the caller must not change the installation.
  static Expected<AuditTrail> open(const std::filesystem::path& folder);

  // Appends a line about a command: `action` is the command, such as "token create", `target` is
  // what it changes, and `is_done` is whether the change was made.
  void record(std::string_view action, std::string_view target, bool is_done) const;

 private:
  explicit AuditTrail(Log log) : log_(std::move(log)) {}

  Log log_;
};

}  // namespace vitrine::server::cli
