// SPDX-License-Identifier: Apache-2.0
// Writes structured log lines. The format is logfmt: key=value, with the value in quotes if needed.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/log/line_batch.h"
#include "server/log/log_file.h"

namespace vitrine::server {

// One answered request. The strings must stay valid only during the call.
struct AccessRecord {
  std::string_view request_id;
  std::string_view remote;  // address of the peer
  std::string_view method;
  std::string_view route;   // the route's template; "-" if no route matched
  std::string_view target;  // target as the client sent it: untrusted text; the log shortens it
  unsigned status = 0;
  std::uint64_t bytes = 0;  // number of body bytes sent
  double seconds = 0;
};

// A request that tried to change data. The strings must stay valid only during the call.
struct AuditRecord {
  std::string_view request_id;
  std::string_view remote;  // address of the peer
  std::string_view token;   // the token's ID; "-" if the request has no valid token
  std::string_view method;
  std::string_view route;   // the route's template
  std::string_view target;  // target as the client sent it: untrusted text; the log shortens it
  unsigned status = 0;
};

// A command that tried to change an installation. The strings must stay valid only during the call.
struct CommandRecord {
  std::string_view user;    // name or number of the user whose rights the command has
  std::string_view login;   // number of the user who logged in; "-" if the kernel does not know it
  std::string_view action;  // such as "token create"
  std::string_view target;  // what the command changes, as the user named it: untrusted text
  bool is_done = false;     // whether the change was made
};

enum class Severity { kInfo, kWarning, kError };

// Thread-safe. Each line is written as a whole to a descriptor opened for appending, so that lines
// of several threads and processes do not mix.
class Log {
 public:
  // Opens a log. "-" means standard error; an empty path discards all lines. Fails with kIo if the
  // file cannot be opened. If the file has `max_bytes` or more after a flush(), it is renamed to
  // FILE.old and the log continues in a new file. 0: no limit.
  static Expected<Log> open(const std::filesystem::path& file, std::uint64_t max_bytes = 0);
  static Log to_stderr();
  // Writes to a file that is already open for appending. Closes the file when the log is destroyed.
  static Log to_file(int descriptor);
  Log(Log&& other) noexcept;
  Log& operator=(Log&& other) noexcept;
  ~Log();

  // Continues the log in `file`, for example after a rotation or under another name. No line is
  // lost or torn. If `file` cannot be opened (kIo), the log continues in the old file.
  Expected<void> reopen(const std::filesystem::path& file, std::uint64_t max_bytes = 0);

  // Adds a line to a batch. Returns true if the caller must call flush() soon. The destructor
  // writes the lines that are left.
  [[nodiscard]] bool access(const AccessRecord& record) const;
  void flush() const;
  void audit(const AuditRecord& record) const;
  void audit(const CommandRecord& record) const;
  void event(Severity severity, std::string_view message) const;

 private:
  explicit Log(int descriptor) : descriptor_(descriptor) {}

  // The log's descriptor. Its number does not change when the log is reopened. It refers to
  // /dev/null if the log discards all lines. It is -1 after a move.
  int descriptor_;
  std::atomic<bool> is_silent_{false};
  std::unique_ptr<LineBatch> batch_ = std::make_unique<LineBatch>();
  std::unique_ptr<LogFile> file_ = std::make_unique<LogFile>();
};

// Returns `value` in logfmt. A value of unambiguous printable ASCII characters stays unquoted. Any
// other value is quoted: \" and \\ are escaped, and every control or non-ASCII byte becomes \xNN. A
// request therefore cannot forge log lines.
std::string logfmt_value(std::string_view value);

}  // namespace vitrine::server
