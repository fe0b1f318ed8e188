// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/child_channel.h"

#include <fmt/core.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <system_error>

namespace vitrine::server {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

enum class MessageKind : std::uint8_t { kProgress, kError, kResult };

struct MessageHeader {
  MessageKind kind{};
  ErrorCode code{};        // code of the error, if the message is an error
  double fraction = 0;     // progress, 0..1
  std::uint64_t size = 0;  // bytes of the text or result that follows
};
constexpr std::uint64_t kMaxText = 4096;

// Exit codes of a child that cannot send an error.
constexpr int kOutOfMemory = 77;
constexpr int kCannotAnswer = 78;
constexpr int kOutOfAddressSpace = 79;  // an inherited limit on the address space was too low
constexpr int kNoThread = 80;
constexpr int kNotLoaded = 127;  // exit code of the dynamic loader

// Returns this process's hard limit on address space, in bytes. A child inherits the limit of its
// parent.
std::uint64_t address_space() {
  rlimit limit{};
  return ::getrlimit(RLIMIT_AS, &limit) == 0 ? limit.rlim_max : RLIM_INFINITY;
}

// The functions from here to in_gigabytes() run in the child.

void send_all(int fd, const void* data, std::size_t size) {
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  while (size > 0) {
    const ssize_t n = ::write(fd, bytes, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) ::_exit(kCannotAnswer);
    bytes += n;
    size -= static_cast<std::size_t>(n);
  }
}

void send_text(int fd, MessageHeader header, std::string_view text) {
  header.size = std::min<std::uint64_t>(text.size(), kMaxText);
  send_all(fd, &header, sizeof header);
  send_all(fd, text.data(), header.size);
}

void send_answer(int fd, const Expected<Bytes>& answer) {
  if (!answer) {
    send_text(fd, {.kind = MessageKind::kError, .code = answer.error().code},
              answer.error().message);
    return;
  }
  const MessageHeader header{.kind = MessageKind::kResult, .size = answer->size()};
  send_all(fd, &header, sizeof header);
  send_all(fd, answer->data(), answer->size());
}

// Whether an inherited limit leaves less address space than the task and the spill file may use.
bool lacks_address_space(const SandboxLimits& limits) {
  const bool cannot_spill = !limits.spill.folder.empty() && spill_capacity() == 0;
  const std::uint64_t most = address_space();
  return most != RLIM_INFINITY && (cannot_spill || most < limits.memory_bytes + spill_capacity());
}

int exit_code_without_memory = kOutOfMemory;

// Ends the process with the exit code for the exception that is being handled.
[[noreturn]] void exit_for_exception() noexcept {
  try {
    if (const auto fault = std::current_exception()) std::rethrow_exception(fault);
  } catch (const std::bad_alloc&) {
    exit_without_memory();
  } catch (const std::system_error& fault) {
    if (fault.code() == std::errc::resource_unavailable_try_again) ::_exit(kNoThread);
  } catch (...) {
  }
  ::_exit(kCannotAnswer);
}

Expected<Bytes> run_confined(int fd, const SandboxLimits& limits, const SandboxedTask& task) {
  if (auto opened = open_spill(limits.spill); !opened) return tl::unexpected(opened.error());
  if (lacks_address_space(limits)) exit_code_without_memory = kOutOfAddressSpace;
  if (auto confined = confine(limits); !confined) return tl::unexpected(confined.error());
  start_trimming();
  return task([fd](std::string_view stage, double fraction) {
    send_text(fd, {.kind = MessageKind::kProgress, .fraction = fraction}, stage);
  });
}

// The code from here to the end of the namespace runs in the parent.

std::string in_gigabytes(std::uint64_t bytes) {
  return fmt::format("{:.3g} GB", static_cast<double>(bytes) / static_cast<double>(1u << 30));
}

Unexpected too_much_memory(const SandboxLimits& limits) {
  return fail(
      ErrorCode::kLimit,
      fmt::format(
          "the mesh needs more than {} of memory; raise the memory limit or make the mesh smaller",
          in_gigabytes(limits.memory_bytes)));
}

// Returns the error for a limit on address space that the child has inherited.
Unexpected too_little_address_space() {
  return fail(ErrorCode::kLimit,
              fmt::format("the mesh needs more address space than the {} that LimitAS of the "
                          "service, or ulimit -v, allows; remove that limit, and bound the "
                          "service's memory by MemoryMax",
                          in_gigabytes(address_space())));
}

Unexpected no_thread() {
  return fail(ErrorCode::kLimit,
              "the system allows no further thread for the mesh; raise TasksMax of the service, or "
              "ulimit -u");
}

Unexpected killed() {
  return fail(ErrorCode::kLimit,
              "the mesh's process was killed, most likely because memory ran out; raise MemoryMax "
              "of the service, free some memory or make the mesh smaller");
}

Unexpected too_much_time(const char* kind, double seconds) {
  return fail(
      ErrorCode::kLimit,
      fmt::format("the mesh needs more than {:g} s of {} time; make it smaller", seconds, kind));
}

Unexpected crashed(std::string_view how) {
  return fail(ErrorCode::kBadInput,
              fmt::format("the isolated reader {}; the file is damaged or hostile, get it from its "
                          "source again",
                          how));
}

Unexpected cause_of_exit(int code, const SandboxLimits& limits) {
  const bool is_limited = address_space() != RLIM_INFINITY;
  switch (code) {
    case kOutOfMemory:
      return too_much_memory(limits);
    case kOutOfAddressSpace:
      return too_little_address_space();
    case kNoThread:
      return is_limited ? too_little_address_space() : no_thread();
    case kNotLoaded:
      if (is_limited) return too_little_address_space();
      break;
    default:
      break;
  }
  return crashed("ended without an answer");
}

// Returns an error that says why the child ended without a result or an error.
Unexpected cause_of_death(int status, const SandboxLimits& limits) {
  if (WIFEXITED(status)) return cause_of_exit(WEXITSTATUS(status), limits);
  if (!WIFSIGNALED(status)) return crashed("ended without an answer");
  switch (WTERMSIG(status)) {
    case SIGKILL:
      return killed();
    case SIGXCPU:
      return too_much_time("processor", limits.cpu_seconds);
    case SIGBUS:
      return fail(ErrorCode::kIo,
                  "the disk of the working file is full, or the input was cut meanwhile; free some "
                  "space and try again");
    case SIGSYS:
      return crashed("was stopped at a forbidden system call");
    default:
      return crashed(fmt::format("crashed ({})", ::strsignal(WTERMSIG(status))));
  }
}

// Replaces control characters by spaces, because hostile bytes may control the child that sent the
// text.
std::string printable(std::span<const std::uint8_t> text) {
  std::string line(text.begin(), text.end());
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return line;
}

class Receiver {
 public:
  Receiver(int fd, const SandboxLimits& limits) : fd_(fd), limits_(limits) {}

  // Returns the child's result, or fails with its error. Returns nullopt if the child closed the
  // pipe without sending either. Passes the progress messages that arrive first to `progress`.
  Expected<std::optional<Bytes>> receive(const ProgressReport& progress) {
    for (;;) {
      MessageHeader header;
      auto got = read_exactly({reinterpret_cast<std::uint8_t*>(&header), sizeof header});
      if (!got) return tl::unexpected(got.error());
      if (!*got) return std::nullopt;
      auto payload = read_payload(header);
      if (!payload || !*payload || header.kind == MessageKind::kResult) return payload;
      if (header.kind == MessageKind::kError) {
        return fail(std::min(header.code, ErrorCode::kIo), printable(**payload));
      }
      if (progress) progress(printable(**payload), header.fraction);
    }
  }

 private:
  // Reads the bytes that follow a header. Returns nullopt if the stream ends early. Allocates
  // memory step by step as bytes arrive, because the announced length may be false.
  Expected<std::optional<Bytes>> read_payload(const MessageHeader& header) {
    constexpr std::uint64_t kStep = 16u << 20;
    if (header.size > (header.kind == MessageKind::kResult ? limits_.answer_bytes : kMaxText)) {
      return fail(ErrorCode::kLimit,
                  fmt::format("the result is larger than {}; make the mesh smaller",
                              in_gigabytes(limits_.answer_bytes)));
    }
    Bytes payload;
    while (payload.size() < header.size) {
      const std::size_t have = payload.size();
      payload.resize(std::min(header.size, have + kStep));
      const auto got = read_exactly(std::span(payload).subspan(have));
      if (!got) return tl::unexpected(got.error());
      if (!*got) return std::nullopt;
    }
    return payload;
  }

  // Fills `out`. Returns false if the stream ends first. Fails with kLimit if the wall time has
  // passed.
  Expected<bool> read_exactly(std::span<std::uint8_t> out) {
    while (!out.empty()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now());
      pollfd waiting{fd_, POLLIN, 0};
      const int ready = left.count() <= 0 ? 0 : ::poll(&waiting, 1, clamp(left.count()));
      if (ready < 0 && errno == EINTR) continue;
      if (ready == 0 && Clock::now() < deadline_) continue;
      if (ready == 0) {
        return too_much_time("wall-clock", std::chrono::duration<double>(limits_.wall).count());
      }
      const ssize_t n = ::read(fd_, out.data(), out.size());
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      out = out.subspan(static_cast<std::size_t>(n));
    }
    return true;
  }

  static int clamp(std::int64_t milliseconds) {
    return static_cast<int>(std::min<std::int64_t>(milliseconds, 1'000'000));
  }

  const int fd_;
  const SandboxLimits& limits_;
  const Clock::time_point deadline_ = Clock::now() + limits_.wall;
};

}  // namespace

void answer_and_exit(int fd, const SandboxLimits& limits, const SandboxedTask& task) noexcept {
  std::set_new_handler(exit_without_memory);
  std::set_terminate(exit_for_exception);
  try {
    send_answer(fd, run_confined(fd, limits, task));
  } catch (...) {
    exit_for_exception();
  }
  ::_exit(0);
}

void exit_without_memory() noexcept {
  ::_exit(exit_code_without_memory);
}

Expected<Bytes> await_answer(pid_t pid, int fd, const SandboxLimits& limits,
                             const ProgressReport& progress) {
  auto answer = Receiver(fd, limits).receive(progress);
  if (!answer) ::kill(pid, SIGKILL);
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (!answer) return tl::unexpected(answer.error());
  if (!*answer) return cause_of_death(status, limits);
  return std::move(**answer);
}

}  // namespace vitrine::server
