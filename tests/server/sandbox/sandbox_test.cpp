// SPDX-License-Identifier: Apache-2.0
#include "server/sandbox/sandbox.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <system_error>
#include <thread>

#include "server/sandbox/separation.h"
#include "support/temporary_folder.h"

namespace vitrine::server {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

// Returns the errno of a system call, or 0 if the call succeeded.
Expected<Bytes> outcome(long result) {
  return Bytes{static_cast<std::uint8_t>(result < 0 ? errno : 0)};
}

Expected<Bytes> run(const SandboxedTask& task, const SandboxLimits& limits = {}) {
  return run_sandboxed(limits, task);
}

std::string error_of(const SandboxedTask& task, const SandboxLimits& limits = {}) {
  const auto answer = run(task, limits);
  EXPECT_FALSE(answer);
  return answer ? "" : answer.error().message;
}

constexpr const char* kForbidden = "forbidden system call";

TEST(Sandbox, ItReturnsWhatTheTaskReturns) {
  Bytes large(3'000'000);
  for (std::size_t i = 0; i < large.size(); ++i)
    large[i] = static_cast<std::uint8_t>(i * 7);
  EXPECT_EQ(run([&](const auto&) { return large; }).value(), large);
  EXPECT_EQ(run([](const auto&) { return Bytes{}; }).value(), Bytes{});
}

TEST(Sandbox, AnErrorOfTheTaskKeepsItsCodeAndText) {
  const auto answer =
      run([](const auto&) -> Expected<Bytes> { return fail(ErrorCode::kUnsupported, "no quads"); });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kUnsupported);
  EXPECT_EQ(answer.error().message, "no quads");
}

TEST(Sandbox, ProgressArrivesInOrder) {
  std::vector<std::pair<std::string, double>> seen;
  const auto answer = run_sandboxed(
      {},
      [](const ProgressReport& report) -> Expected<Bytes> {
        report("read", 0.5);
        report("simplify", 0.25);
        return Bytes{1};
      },
      [&](std::string_view stage, double fraction) { seen.emplace_back(stage, fraction); });
  EXPECT_TRUE(answer);
  EXPECT_EQ(seen, (std::vector<std::pair<std::string, double>>{{"read", 0.5}, {"simplify", 0.25}}));
}

TEST(Sandbox, TheChildsMemoryIsItsOwn) {
  int value = 1;
  EXPECT_TRUE(run([&](const auto&) { return value = 2, Bytes{}; }));
  EXPECT_EQ(value, 1);
}

TEST(Sandbox, ThreadsWorkInside) {
  const auto answer = run([](const auto&) -> Expected<Bytes> {
    int sum = 0;
    std::thread thread([&] { sum = 42; });
    thread.join();
    return Bytes{static_cast<std::uint8_t>(sum)};
  });
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{42});
}

TEST(Sandbox, NoFileCanBeRead) {
  const auto open_file = [](const auto&) { return outcome(::open("/etc/passwd", O_RDONLY)); };
  EXPECT_EQ(run(open_file).value(), Bytes{EACCES});
}

TEST(Sandbox, NoFileCanBeCreated) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "planted";
  const auto create = [&](const auto&) {
    return outcome(::open(path.c_str(), O_WRONLY | O_CREAT, 0644));
  };
  EXPECT_EQ(run(create).value(), Bytes{EACCES});
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Sandbox, NoFileCanBeRemoved) {
  const test::TemporaryFolder folder;
  const auto path = folder.path().string();
  EXPECT_THAT(error_of([&](const auto&) { return outcome(::rmdir(path.c_str())); }),
              HasSubstr(kForbidden));
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(Sandbox, NoSocketCanBeMade) {
  EXPECT_THAT(error_of([](const auto&) { return outcome(::socket(AF_INET, SOCK_STREAM, 0)); }),
              HasSubstr(kForbidden));
}

TEST(Sandbox, NoProgramCanBeStarted) {
  EXPECT_THAT(error_of([](const auto&) {
                char* const arguments[] = {const_cast<char*>("true"), nullptr};
                return outcome(::execv("/bin/true", arguments));
              }),
              HasSubstr(kForbidden));
}

TEST(Sandbox, NoProcessCanBeStarted) {
  EXPECT_THAT(error_of([](const auto&) { return outcome(::syscall(SYS_fork)); }),
              HasSubstr(kForbidden));
  EXPECT_THAT(error_of([](const auto&) {
                return outcome(::syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr));
              }),
              HasSubstr(kForbidden));
}

TEST(Sandbox, NoProcessCanBeTracedOrSignalled) {
  const pid_t parent = ::getpid();
  EXPECT_THAT(error_of([&](const auto&) {
                return outcome(::ptrace(PTRACE_ATTACH, parent, nullptr, nullptr));
              }),
              HasSubstr(kForbidden));
  EXPECT_THAT(error_of([&](const auto&) { return outcome(::kill(parent, 0)); }),
              HasSubstr(kForbidden));
  EXPECT_THAT(
      error_of([&](const auto&) { return outcome(::syscall(SYS_tgkill, parent, parent, 0)); }),
      HasSubstr(kForbidden));
}

TEST(Sandbox, NoMemoryBecomesCode) {
  EXPECT_THAT(error_of([](const auto&) {
                void* page = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC,
                                    MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
                return outcome(page == MAP_FAILED ? -1 : 0);
              }),
              HasSubstr(kForbidden));
}

TEST(Sandbox, TheLimitsCannotBeRaisedAgain) {
  const auto raise = [](const auto&) {
    const rlimit none{RLIM_INFINITY, RLIM_INFINITY};
    return outcome(::setrlimit(RLIMIT_AS, &none));
  };
  EXPECT_EQ(run(raise).value(), Bytes{EACCES});
}

TEST(Sandbox, DescriptorsOfTheParentAreOutOfReach) {
  const test::TemporaryFolder folder;
  const int secret = ::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_GE(secret, 0);
  const auto look = [&](const auto&) {
    struct stat status {};
    return outcome(::syscall(SYS_fstat, secret, &status));
  };
  EXPECT_EQ(run(look).value(), Bytes{EBADF});
  ::close(secret);
}

// Builds with sanitizers omit this test: their shadow memory needs more address space than any
// limit allows.
#ifndef VITRINE_SANITISED
TEST(Sandbox, MemoryBeyondTheLimitIsALimitErrorThatSaysHowMuch) {
  const SandboxLimits limits{.memory_bytes = 1ull << 30};
  const SandboxedTask hog = [](const auto&) -> Expected<Bytes> {
    std::vector<std::unique_ptr<Bytes>> blocks;
    for (;;)
      blocks.push_back(std::make_unique<Bytes>(64 << 20, std::uint8_t{1}));
  };
  const auto answer = run(hog, limits);
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kLimit);
  EXPECT_THAT(answer.error().message, HasSubstr("more than 1 GB of memory"));
}

// Runs `task` in the sandbox of a process whose address space is limited, as by LimitAS= of
// systemd. Returns the error message.
std::string error_under(rlim_t address_space, const SandboxedTask& task) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit limit{address_space, address_space};
    ::setrlimit(RLIMIT_AS, &limit);
    const auto inner = run(task);
    const std::string text = inner ? "no error" : inner.error().message;
    ::_exit(::write(ends[1], text.data(), text.size()) < 0 ? 1 : 0);
  }
  ::close(ends[1]);
  std::string text(4096, '\0');
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(::read(ends[0], text.data(), 4096), 0)));
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return text;
}

TEST(Sandbox, AnInheritedLimitOnTheAddressSpaceIsNamed) {
  const SandboxedTask hog = [](const auto&) -> Expected<Bytes> { return Bytes(2ull << 30); };
  EXPECT_THAT(error_under(1ull << 30, hog),
              HasSubstr("more address space than the 1 GB that LimitAS of the service"));
  EXPECT_EQ(error_under(1ull << 30, [](const auto&) { return Bytes{}; }), "no error");
}

// The task unmaps a part of the spill file, and then tries to map private memory in its place.
TEST(Sandbox, TheAddressSpaceOfTheSpillFileIsOfNoOtherUse) {
  constexpr std::size_t kLimit = 256u << 20, kPart = 1u << 30;
  const test::TemporaryFolder folder;
  const auto task = [](const auto&) -> Expected<Bytes> {
    if (spill_capacity() < kPart) return fail(ErrorCode::kLimit, "the disk has too little room");
    auto* const spilled = new std::uint8_t[1 << 20];  // the first block starts the spill file
    if (spilled_bytes() == 0 || ::munmap(spilled, kPart) != 0)
      return fail(ErrorCode::kIo, "the block was not spilled");
    return outcome(::mmap(nullptr, 2 * kLimit, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS,
                          -1, 0) == MAP_FAILED
                       ? -1
                       : 0);
  };
  const auto answer =
      run(task, {.memory_bytes = kLimit, .spill = {.folder = folder.path(), .resident_bytes = 1}});
  ASSERT_TRUE(answer) << answer.error().message;
  EXPECT_EQ(*answer, Bytes{ENOMEM});
}

TEST(Sandbox, AThreadThatTheSystemRefusesIsALimitError) {
  const SandboxedTask start = [](const auto&) -> Expected<Bytes> {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  };
  EXPECT_THAT(error_of(start), HasSubstr("raise TasksMax of the service"));
  EXPECT_THAT(error_under(2ull << 30, start), HasSubstr("LimitAS of the service"));
}

TEST(Sandbox, OneAllocationOfFourGigabytesIsBeyondTheDefaultLimit) {
  const auto answer =
      run([](const auto&) -> Expected<Bytes> { return Bytes{Bytes(4ull << 30)[12345]}; });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kLimit);
  EXPECT_THAT(answer.error().message, HasSubstr("more than 4 GB of memory"));
}
#endif

[[noreturn]] void loop_forever() {
  for (volatile bool forever = true; forever;) {
  }
  ::abort();
}

TEST(Sandbox, AnEndlessLoopEndsAtTheProcessorTime) {
  const auto answer =
      run([](const auto&) -> Expected<Bytes> { loop_forever(); }, {.cpu_seconds = 1});
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kLimit);
  EXPECT_THAT(answer.error().message, HasSubstr("more than 1 s of processor time"));
}

TEST(Sandbox, AnEndlessSleepEndsAtTheWallTime) {
  const auto sleep_forever = [](const auto&) -> Expected<Bytes> {
    for (;;)
      ::sleep(1'000);
  };
  const auto answer = run(sleep_forever, {.wall = std::chrono::milliseconds(100)});
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kLimit);
  EXPECT_THAT(answer.error().message, HasSubstr("more than 0.1 s of wall-clock time"));
}

TEST(Sandbox, AResultBeyondTheLimitIsRefused) {
  const auto answer = run([](const auto&) { return Bytes(10'001); }, {.answer_bytes = 10'000});
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kLimit);
}

TEST(Sandbox, ACrashIsAnErrorAndNotACrashHere) {
  const auto answer = run([](const auto&) -> Expected<Bytes> {
    ::signal(SIGSEGV, SIG_DFL);
    ::raise(SIGSEGV);
    return Bytes{};
  });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(answer.error().message, HasSubstr("crashed (Segmentation fault)"));
}

TEST(Sandbox, AChildThatTheKernelKillsForItsMemoryIsALimitError) {
  const auto answer = run([](const auto&) -> Expected<Bytes> {
    ::raise(SIGKILL);
    return Bytes{};
  });
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::kLimit);
  EXPECT_THAT(answer.error().message, HasSubstr("memory ran out; raise MemoryMax"));
}

// Calls `look` with the folder /proc/PID of a sandboxed child, and returns its result. The child
// waits during the call.
std::string look_at_child(const std::function<std::string(const std::filesystem::path&)>& look) {
  std::string found;
  const auto answer = run_sandboxed(
      {},
      [](const ProgressReport& report) -> Expected<Bytes> {
        for (int i = 0; i < 10'000; ++i)  // more than the pipe holds, so the child must wait
          report("a stage with a long name", 0.5);
        return Bytes{};
      },
      [&](std::string_view, double) {
        if (!found.empty()) return;
        std::string pid;
        std::ifstream("/proc/thread-self/children") >> pid;
        found = look(std::filesystem::path("/proc") / pid);
      });
  EXPECT_TRUE(answer);
  return found;
}

#ifndef VITRINE_SANITISED  // the sanitizers' threads keep a process from leaving its namespaces
// Returns whether the kernel lets a process of this user enter a new network namespace.
bool can_leave_network() {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(leave_network() ? 0 : 1);
  int status = 0;
  ::waitpid(child, &status, 0);
  return status == 0;
}

// Skips the test. If VITRINE_NO_SKIPS is set, the test fails instead.
#define SKIP_IF_ALLOWED(reason)                                      \
  do {                                                               \
    ASSERT_EQ(std::getenv("VITRINE_NO_SKIPS"), nullptr) << (reason); \
    GTEST_SKIP() << (reason);                                        \
  } while (false)

TEST(Sandbox, TheChildHasANetworkOfItsOwn) {
  if (!can_leave_network()) SKIP_IF_ALLOWED("the kernel allows no network namespaces here");
  std::error_code refused;
  const auto network_of = [&](const std::filesystem::path& process) {
    const auto network = std::filesystem::read_symlink(process / "ns/net", refused).string();
    return refused ? "unknown" : network;
  };
  const std::string own = network_of("/proc/self"), childs = look_at_child(network_of);
  if (refused) SKIP_IF_ALLOWED("only root may look at a confined process");
  EXPECT_THAT(childs, ::testing::StartsWith("net:["));
  EXPECT_NE(childs, own);
}
#endif

// Makes unshare() fail, as RestrictNamespaces= in the shipped systemd unit does.
bool restrict_namespaces() {
  sock_filter steps[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_unshare, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog filter{.len = 4, .filter = steps};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) == 0 && !leave_network();
}

TEST(Sandbox, TheChildWorksAndHasNoNetworkIfTheServiceManagerForbidsNamespaces) {
  const pid_t service = ::fork();
  if (service == 0) {
    if (!restrict_namespaces()) ::_exit(1);
    if (!run([](const auto&) { return Bytes{}; })) ::_exit(2);
    const auto answer = run([](const auto&) { return outcome(::socket(AF_INET, SOCK_STREAM, 0)); });
    ::_exit(!answer && answer.error().message.find(kForbidden) != std::string::npos ? 0 : 3);
  }
  int status = 0;
  ::waitpid(service, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Sandbox, TheKernelKillsTheChildFirstIfMemoryRunsOut) {
  EXPECT_EQ(look_at_child([](const std::filesystem::path& process) {
              std::string score;
              std::ifstream(process / "oom_score_adj") >> score;
              return score;
            }),
            "1000");
}

TEST(Sandbox, AnUncaughtExceptionIsAnError) {
  EXPECT_THAT(error_of([](const auto&) -> Expected<Bytes> { throw 1; }),
              HasSubstr("ended without an answer"));
}

TEST(Sandbox, NoChildOutlivesTheCall) {
  EXPECT_TRUE(run([](const auto&) { return Bytes{}; }));
  error_of(
      [](const auto&) -> Expected<Bytes> {
        for (;;)
          ::sleep(1'000);
      },
      {.wall = std::chrono::milliseconds(10)});
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

}  // namespace
}  // namespace vitrine::server
