// SPDX-License-Identifier: Apache-2.0
// Structured log lines (logfmt: key=value, values quoted where needed), each written whole.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/log/line_batch.h"

namespace vitrine {

// One answered request. The strings are borrowed for the call.
struct AccessRecord {
  std::string_view request_id;
  std::string_view remote;  // address of the peer
  std::string_view method;
  std::string_view route;   // the route's template, "-" where none matched
  std::string_view target;  // as sent: hostile text
  unsigned status = 0;
  std::uint64_t bytes = 0;  // of the body, as sent
  double seconds = 0;
};

// A call that was to change something, whoever made it. The strings are borrowed for the call.
struct AuditRecord {
  std::string_view request_id;
  std::string_view remote;  // address of the peer
  std::string_view token;   // the token's id, "-" where there was none in force
  std::string_view method;
  std::string_view route;   // the route's template
  std::string_view target;  // as sent: hostile text
  unsigned status = 0;
};

enum class Severity { kInfo, kWarning, kError };

// Thread-safe: lines are written whole to a descriptor opened for appending, so that those of
// several threads and processes do not mix.
class Log {
 public:
  // "-" is standard error; an empty path drops everything. Fails (kIo) where the file is refused.
  static Expected<Log> open(const std::filesystem::path& file);
  static Log to_stderr();
  Log(Log&& other) noexcept;
  Log& operator=(Log&& other) noexcept;
  ~Log();

  // Goes on in `file`, opened anew, as after a rotation or under another name; no line is lost or
  // torn. Fails (kIo) where the file is refused: the log goes on as it was.
  Expected<void> reopen(const std::filesystem::path& file);

  // The line may wait for others: where this is true, the caller sees to a flush() soon. What waits
  // when the log is destroyed is written then.
  [[nodiscard]] bool access(const AccessRecord& record) const;
  void flush() const;
  void audit(const AuditRecord& record) const;
  void event(Severity severity, std::string_view message) const;

 private:
  explicit Log(int descriptor) : descriptor_(descriptor) {}

  // Its number stays for life, so that nobody has to be told when it is opened anew. Where nothing
  // is logged, it is one of /dev/null, and -1 after a move.
  int descriptor_;
  std::atomic<bool> silent_{false};
  std::unique_ptr<LineBatch> batch_ = std::make_unique<LineBatch>();
};

// `value` as logfmt: bare where it holds only unambiguous printable ASCII, else quoted with \"
// and \\ escaped and every control or non-ASCII byte as \xNN, so that no request can forge a line.
std::string logfmt_value(std::string_view value);

}  // namespace vitrine
