// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/child_channel.h"

#include <fmt/core.h>
#include <poll.h>
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

namespace vitrine {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Clock = std::chrono::steady_clock;

enum class Kind : std::uint8_t { kProgress, kError, kResult };

struct Header {
  Kind kind{};
  ErrorCode code{};        // of an error
  double fraction = 0;     // of progress
  std::uint64_t size = 0;  // of the text or the bytes that follow
};
constexpr std::uint64_t kMaxText = 4096;

constexpr int kOutOfMemory = 77;  // exit codes of a child that cannot answer
constexpr int kCannotAnswer = 78;

// --- the child ---

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

void send_text(int fd, Header header, std::string_view text) {
  header.size = std::min<std::uint64_t>(text.size(), kMaxText);
  send_all(fd, &header, sizeof header);
  send_all(fd, text.data(), header.size);
}

void send_answer(int fd, const Expected<Bytes>& answer) {
  if (!answer) {
    send_text(fd, {.kind = Kind::kError, .code = answer.error().code}, answer.error().message);
    return;
  }
  const Header header{.kind = Kind::kResult, .size = answer->size()};
  send_all(fd, &header, sizeof header);
  send_all(fd, answer->data(), answer->size());
}

Expected<Bytes> run_confined(int fd, const SandboxLimits& limits, const SandboxedTask& task) {
  if (auto opened = open_spill(limits.spill); !opened) return tl::unexpected(opened.error());
  if (auto confined = confine(limits); !confined) return tl::unexpected(confined.error());
  start_trimming();
  return task([fd](std::string_view stage, double fraction) {
    send_text(fd, {.kind = Kind::kProgress, .fraction = fraction}, stage);
  });
}

// --- the parent ---

std::string in_gigabytes(std::uint64_t bytes) {
  return fmt::format("{:.3g} GB", static_cast<double>(bytes) / static_cast<double>(1u << 30));
}

Unexpected too_much_memory(const SandboxLimits& limits) {
  return fail(ErrorCode::kLimit,
              fmt::format("the mesh needs more than {} of memory; give it more or make it smaller",
                          in_gigabytes(limits.memory_bytes)));
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

// Why a child ended that sent neither a result nor an error.
Unexpected cause_of_death(int status, const SandboxLimits& limits) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemory) return too_much_memory(limits);
  if (!WIFSIGNALED(status)) return crashed("ended without an answer");
  switch (WTERMSIG(status)) {
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

// Text of a child that may have been taken over: one line, nothing that steers a terminal.
std::string printable(std::span<const std::uint8_t> text) {
  std::string line(text.begin(), text.end());
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return line;
}

class Receiver {
 public:
  Receiver(int fd, const SandboxLimits& limits) : fd_(fd), limits_(limits) {}

  // Nothing where the child closed its end before it gave an answer.
  Expected<std::optional<Bytes>> receive(const ProgressReport& progress) {
    for (;;) {
      Header header;
      auto got = read_exactly({reinterpret_cast<std::uint8_t*>(&header), sizeof header});
      if (!got) return tl::unexpected(got.error());
      if (!*got) return std::nullopt;
      auto payload = read_payload(header);
      if (!payload || !*payload || header.kind == Kind::kResult) return payload;
      if (header.kind == Kind::kError) {
        return fail(std::min(header.code, ErrorCode::kIo), printable(**payload));
      }
      if (progress) progress(printable(**payload), header.fraction);
    }
  }

 private:
  // Memory grows with what has come, not with what is announced.
  Expected<std::optional<Bytes>> read_payload(const Header& header) {
    constexpr std::uint64_t kStep = 16u << 20;
    if (header.size > (header.kind == Kind::kResult ? limits_.answer_bytes : kMaxText)) {
      return fail(ErrorCode::kLimit,
                  fmt::format("the answer is larger than {}; make the mesh smaller",
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

  // False at the end of the stream; kLimit once the wall time is over.
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
  std::set_new_handler([] { ::_exit(kOutOfMemory); });
  std::set_terminate([] { ::_exit(kCannotAnswer); });
  send_answer(fd, run_confined(fd, limits, task));
  ::_exit(0);
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

}  // namespace vitrine
