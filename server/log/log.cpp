// SPDX-License-Identifier: Apache-2.0
#include "server/log/log.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/log/write_whole.h"

namespace vitrine::server {
namespace {

using LogLine = fmt::memory_buffer;

bool is_plain(char c) {
  return c > ' ' && c < 0x7f && c != '"' && c != '=' && c != '\\';
}

void append_text(LogLine& line, std::string_view text) {
  line.append(text.data(), text.data() + text.size());
}

// Returns how many bytes append_value() writes for a character of a quoted value.
std::size_t escaped_size(char c) {
  if (c == '"' || c == '\\') return 2;
  return c >= ' ' && c < 0x7f ? 1 : 4;
}

void append_value(LogLine& line, std::string_view value) {
  if (!value.empty() && std::ranges::all_of(value, is_plain)) return append_text(line, value);
  const auto out = std::back_inserter(line);
  fmt::format_to(out, "\"");
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      fmt::format_to(out, "\\{}", c);
    } else if (c >= ' ' && c < 0x7f) {
      fmt::format_to(out, "{}", c);
    } else {
      fmt::format_to(out, "\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  fmt::format_to(out, "\"");
}

void append(LogLine& line, std::string_view key, std::string_view value) {
  append_text(line, " ");
  append_text(line, key);
  append_text(line, "=");
  append_value(line, value);
}

// Appends a text that a client has sent. Cuts off long texts, so that no request can cause a long
// line.
void append_cut(LogLine& line, std::string_view key, std::string_view value) {
  constexpr std::size_t kLongest = 256;  // in bytes, after escaping
  std::size_t kept = 0;
  for (std::size_t written = 0; kept < value.size(); ++kept) {
    written += escaped_size(value[kept]);
    if (written > kLongest) break;
  }
  append(line, key, value.substr(0, kept));
  if (kept < value.size())
    fmt::format_to(std::back_inserter(line), " {}_bytes={}", key, value.size());
}

void append_time(LogLine& line) {
  const auto now =
      std::chrono::time_point_cast<std::chrono::milliseconds>(std::chrono::system_clock::now());
  const auto seconds = std::chrono::floor<std::chrono::seconds>(now);
  thread_local std::chrono::sys_seconds made{};
  thread_local std::string text;  // the formatted time, updated once per second
  if (made != seconds) {
    made = seconds;
    text = fmt::format("time={:%Y-%m-%dT%H:%M:%S}",
                       fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
  }
  fmt::format_to(std::back_inserter(line), "{}.{:03}Z", text, (now - seconds).count());
}

// Returns the beginning of a line for an access or an audit record: time, event, and the request's
// ID and address.
LogLine line_of(std::string_view event, const auto& record) {
  LogLine line;
  append_time(line);
  append(line, "event", event);
  append(line, "id", record.request_id);
  append(line, "remote", record.remote);
  return line;
}

void append_request(LogLine& line, const auto& record) {
  append_cut(line, "method", record.method);
  append(line, "route", record.route);
  append_cut(line, "target", record.target);
}

std::string_view name(Severity severity) {
  switch (severity) {
    case Severity::kInfo:
      return "info";
    case Severity::kWarning:
      return "warning";
    case Severity::kError:
      return "error";
  }
  return "";
}

void write_line(int descriptor, LogLine& line) {
  line.push_back('\n');
  write_whole(descriptor, {line.data(), line.size()});
}

}  // namespace

Expected<Log> Log::open(const std::filesystem::path& file, std::uint64_t max_bytes) {
  Log log = to_stderr();
  if (auto opened = log.reopen(file, max_bytes); !opened) return tl::unexpected(opened.error());
  return log;
}

Log Log::to_stderr() {
  return Log(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0));
}

Log Log::to_file(int descriptor) {
  return Log(descriptor);
}

Expected<void> Log::reopen(const std::filesystem::path& file, std::uint64_t max_bytes) {
  flush();
  if (auto opened = file_->open(descriptor_, file, max_bytes); !opened) return opened;
  is_silent_ = file.empty();
  return {};
}

Log::Log(Log&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      is_silent_(other.is_silent_.load()),
      batch_(std::exchange(other.batch_, std::make_unique<LineBatch>())),
      file_(std::exchange(other.file_, std::make_unique<LogFile>())) {}

Log& Log::operator=(Log&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  is_silent_ = other.is_silent_.exchange(is_silent_);
  std::swap(batch_, other.batch_);
  std::swap(file_, other.file_);
  return *this;
}

Log::~Log() {
  flush();
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool Log::access(const AccessRecord& record) const {
  if (is_silent_.load(std::memory_order_relaxed)) return false;
  LogLine line = line_of("access", record);
  append_request(line, record);
  const auto microseconds = static_cast<std::uint64_t>(record.seconds * 1e6 + 0.5);
  fmt::format_to(std::back_inserter(line), " status={} bytes={} seconds={}.{:06}", record.status,
                 record.bytes, microseconds / 1'000'000, microseconds % 1'000'000);
  line.push_back('\n');
  return batch_->add({line.data(), line.size()}, descriptor_);
}

void Log::flush() const {
  if (descriptor_ < 0) return;
  batch_->flush(descriptor_);
  file_->replace_if_full(descriptor_);
}

void Log::audit(const AuditRecord& record) const {
  if (is_silent_.load(std::memory_order_relaxed)) return;
  LogLine line = line_of("audit", record);
  append(line, "token", record.token);
  append_request(line, record);
  fmt::format_to(std::back_inserter(line), " status={}", record.status);
  write_line(descriptor_, line);
}

void Log::audit(const CommandRecord& record) const {
  LogLine line;
  append_time(line);
  append(line, "event", "audit");
  append(line, "user", record.user);
  append(line, "login", record.login);
  append(line, "action", record.action);
  append(line, "target", record.target);
  append(line, "outcome", record.is_done ? "done" : "failed");
  write_line(descriptor_, line);
}

// Ignores exceptions. This function also reports that memory has run out. If that report fails as
// well, nothing more can be done.
void Log::event(Severity severity, std::string_view message) const try {
  if (is_silent_.load(std::memory_order_relaxed)) return;
  LogLine line;
  append_time(line);
  append(line, "event", name(severity));
  append(line, "message", message);
  write_line(descriptor_, line);
} catch (const std::exception&) {
}

std::string logfmt_value(std::string_view value) {
  LogLine line;
  append_value(line, value);
  return fmt::to_string(line);
}

}  // namespace vitrine::server
